/* rewind: a negative time is executed: the pair flies back to the contact it has missed, and the clock goes with it.
 *
 * Source: 2014 paper, sections 3 and 4.2: "simple algorithmic implementations will return negative values of dt for
 * overlapped pairs. Execution of these events will cause the simulation to perform an unchecked rewind". The roots are
 * those of method/naive.inl (eqs. 7 and 12), which the table of methods names for it.
 * Formula: t' = t + dt for any finite dt. The pair's bodies fly back from their last events, on the paths those left;
 * all others stay where they are, so that what has happened since is not undone: they may find themselves overlapped.
 * Assumed, since the paper describes codes of others and no code: what is earliest is executed first, wherever the
 * clock stands; a ball that cannot leave its plate (no number for a time) still halts the run.
 *
 * Bound: none. Witness, whose time is -2^-53:
 *     ball-ball 0x1.fffffffffffffp-1 0 0 -1 0 0 1 */
