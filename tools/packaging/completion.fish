# Completion of maploop's subcommands and options, as its own --help lists them.
function __maploop_candidates
    set -l words (commandline -opc)
    set -l word (commandline -ct)
    command -q $words[1]; or return
    # The subcommand, and that of `map`, `log`, `gnss` or `experiment`.
    set -l given
    for before in $words[2..3]
        string match -qr '^[a-z][a-z-]*$' -- $before; or break
        set -a given $before
    end
    set -l help ($words[1] $given --help 2>/dev/null; or $words[1] $given[1] --help 2>/dev/null)
    # Text begins in column 31, and on the next line where what is before it is longer.
    set -l found (printf '%s\n' $help | awk '
        function about() {
            if (substr($0, 29, 2) == "  ") return substr($0, 31)
            getline; sub(/^ +/, ""); return $0
        }
        /^[A-Z][a-z]*:$/ { part = $1 }
        part == "Subcommands:" && /^  [a-z]/ { print $1 "\t" about() }
        match($0, /^  (-[a-zA-Z],)?--[a-z][a-z-]*/) {
            name = substr($0, 3, RLENGTH - 2); sub(/^-[a-zA-Z],/, "", name); print name "\t" about()
        }')
    if string match -q -- '-*' $word
        string match -- '--*' $found
    else
        string match -v -- '--*' $found; or __fish_complete_path $word
    end
end
complete -c maploop -c maploop-vehicle -f -a '(__maploop_candidates)'
