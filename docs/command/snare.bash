# Completion of snare for bash; made by scripts/command_help.py from the command's help.
_snare() {
  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} verb=${COMP_WORDS[1]} ending words files=""
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W "reproduce push fit trace distil compare simulate ringdown sweep benchmark validate arm new export -h --help --version" -- "$current")
    return
  fi
  case $before in
    --out) mapfile -t COMPREPLY < <(compgen -d -- "$current"); return ;;
    --set | --threads | --pose | --case | --body | --axis | --*-mm) return ;;
  esac
  case $verb in
    reproduce)
      words="-h --help --out --threads --set --quiet --json"
      files="toml" ;;
    push)
      words="-h --help --out --threads --set --quiet --json"
      files="toml" ;;
    fit)
      words="-h --help --out --threads --set --quiet --json"
      files="toml" ;;
    trace)
      words="-h --help --out --threads --set --quiet --json"
      files="toml" ;;
    distil)
      words="-h --help --out --threads --set --quiet --json"
      files="toml" ;;
    compare)
      words="-h --help --out --threads --set --quiet --json"
      files="toml" ;;
    simulate)
      words="-h --help --out --threads --set --quiet --json"
      files="toml" ;;
    ringdown)
      words="-h --help --out --threads --set --quiet --json"
      files="toml" ;;
    sweep)
      words="-h --help --out --threads --set --quiet --json --case"
      files="toml" ;;
    benchmark)
      words="-h --help --out --threads --set --quiet --json --case --against --archive"
      files="toml" ;;
    validate)
      words="-h --help --out --threads --set --quiet --json"
      files="" ;;
    arm)
      ((COMP_CWORD == 2)) && words="show" || {
        words="-h --help --pose --set --json"
        files="toml urdf"
      } ;;
    new)
      words="capture experiment wire -h --help --out --quiet"
      files="" ;;
    export)
      words="-h --help --mujoco --body --position-mm --slack-mm --axis --point-mm --first-touch-mm --case --out --quiet"
      files="json xml" ;;
    *) return ;;
  esac
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
  [[ $current == -* || -z $files ]] && return
  compopt -o filenames 2>/dev/null
  for ending in $files; do
    mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -X "!*.$ending" -- "$current")
  done
  mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -d -- "$current")
}
complete -F _snare snare
