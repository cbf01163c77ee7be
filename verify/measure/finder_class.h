/* What can become of a question that a finder is asked. Faults are counted class by class, never summed together:
 *
 *	missed      there is an event, and none was found (beyond the largest double, infinity is no miss)
 *	phantom     there is none, and one was found
 *	negative    the answer is a time before now, whether or not there is an event
 *	nan         the answer is not a number
 *	undefined   the question holds an infinity or a NaN: nothing is said of the answer, and the oracle is not asked
 *
 * The others are right: rightly never, or found, and these have an error in ulp, |got - exact| / ulp(exact) with the
 * ulp of binary64 (whatever arithmetic the finder works in), at least 2^-1074; and they leave a gap, the distance that
 * the bodies are from contact at the time found, in the question's own unit of length. Only a time later than now at
 * which the bodies truly touch has a gap: not an overlap that is ended now, and not the turning point of a pair that is
 * nowhere in contact. */
#ifndef VERIFY_FINDER_CLASS_H
#define VERIFY_FINDER_CLASS_H

enum finder_class {
	FINDER_FOUND,
	FINDER_RIGHTLY_NEVER,
	FINDER_MISSED,
	FINDER_PHANTOM,
	FINDER_NEGATIVE,
	FINDER_NAN,
	FINDER_UNDEFINED,
};
enum { FINDER_CLASSES = 7 };

/* A word for a class: "missed". */
const char *finder_class_name(enum finder_class class);

#endif
