# Completion for bash. What there is to choose from is read from the program: its --help, and `touchstone list`.

# The names of one kind, such as methods.
_touchstone_names() {
	"$1" list "$2" 2>/dev/null | sed -n 's/^  \([^ ]\{1,\}\)  .*/\1/p'
}

# The kinds there are: what the usage of `list` has between bars.
_touchstone_kinds() {
	"$1" list --help | sed '/^$/,$d' | grep -oE '\[[a-z]+(\|[a-z]+)+\]' | tr '[]|' '   '
}

# The kind that a word stands for, such as methods for METHOD or --method.
_touchstone_kind() {
	local word=$2 kind
	case $word in scene) word=case ;; against) word=arithmetic ;; esac
	for kind in $(_touchstone_kinds "$1"); do
		case $kind in "${word}s" | "${word%y}ies") echo "$kind" ;; esac
	done
}

_touchstone() {
	local program=${COMP_WORDS[0]} command=${COMP_WORDS[1]} word=${COMP_WORDS[COMP_CWORD]}
	local before=${COMP_WORDS[COMP_CWORD - 1]} help kind wanted
	COMPREPLY=()
	[[ $word == = ]] && word=''
	[[ $before == = ]] && before=${COMP_WORDS[COMP_CWORD - 2]}
	if ((COMP_CWORD == 1)); then
		mapfile -t COMPREPLY < <(compgen -W "$("$program" --help |
			sed -n '/^ Commands:/,/^$/s/^  \([a-z]\{1,\}\)  .*/\1/p')" -- "$word")
		return
	fi
	help=$("$program" "$command" --help 2>/dev/null) || return
	if [[ $word == -* ]]; then
		mapfile -t COMPREPLY < <(compgen -W "$(grep -oE -- '^ +(-., )?--[a-z-]+' <<<"$help" | grep -oE -- '--[a-z-]+')" \
			-- "$word")
		return
	fi
	if [[ $before == --* ]]; then
		wanted=${before#--}
	elif [[ $command == list ]]; then
		mapfile -t COMPREPLY < <(compgen -W "$(_touchstone_kinds "$program")" -- "$word")
		return
	elif [[ $command == campaign ]]; then
		wanted=campaign
	else # what the usage names in capitals, behind the options
		wanted=$(sed -n '1s/.*\[OPTION\.\.\.\] *\[\{0,1\}\([A-Z]*\).*/\1/p' <<<"$help" | tr A-Z a-z)
	fi
	kind=$(_touchstone_kind "$program" "$wanted")
	[[ $kind ]] && mapfile -t COMPREPLY < <(compgen -W "$(_touchstone_names "$program" "$kind")" -- "$word")
}

complete -o default -F _touchstone touchstone
