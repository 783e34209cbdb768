"""Completions for bash and zsh: subcommands, flags, and the values of flags that are files or words.

The words of a kind of value, such as "COLUMN,...", stand in a function of their own. A kind that ends in ",..." is a
list, and one that holds "=" is completed up to that sign.
"""

import re

NO_VALUE = ""
FILE = "FILE"


def kind(option, values):
    """Whether the value of an option is absent, a file, one of some words, a kind of value by its name, or else."""
    value = option["positional"] or option["value"]
    if not value:
        return NO_VALUE
    if value in values:
        return value
    # "text|json|csv" names the words that are possible; "FILE.svg|.png" names files.
    if re.fullmatch(r"[a-z]+(\|[a-z]+)+", value):
        return value.split("|")
    return FILE if "FILE" in value or "PATH" in value else None


def value_function(program, value):
    return f"_{program}_{re.match('[A-Z]+', value)[0].lower()}_{'range' if ':' in value else 'word'}"


def used(program, values):
    """The kinds of values that some option of the program takes."""
    kinds = {kind(option, values) for _, command in walk(program) for option in command["options"]
             if not isinstance(kind(option, values), list)}
    return [value for value in values if value in kinds]


def flags(command):
    return [name for option in command["options"] if not option["positional"] for name in option["names"]]


def walk(command, path=()):
    """Yields every command below a program, with the words that lead to it."""
    yield path, command
    for sub in command.get("commands", []):
        yield from walk(sub, (*path, sub["name"]))


def bash_values(name, value, words):
    """A function that completes one kind of value."""
    if value.endswith(",..."):
        body = """  local before=''
  [[ $cur == *,* ]] && before=${cur%,*},
  mapfile -t COMPREPLY < <(compgen -P "$before" -W "$words" -- "${cur##*,}")
  compopt -o nospace 2>/dev/null"""
    elif "=" in value:
        body = """  [[ $cur == *=* ]] && return
  mapfile -t COMPREPLY < <(compgen -S = -W "$words" -- "$cur")
  compopt -o nospace 2>/dev/null"""
    else:
        body = """  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$cur")"""
    return f"{value_function(name, value)}() {{\n  local words='{' '.join(words)}'\n{body}\n}}\n"


def bash_reply(name, what, values):
    """The command that completes a value."""
    if what == FILE:
        return "_filedir"
    if isinstance(what, list) or what is None:
        return f"COMPREPLY=($(compgen -W '{' '.join(what or [])}' -- \"$cur\"))"
    return value_function(name, what)


def bash(program, kinds):
    name = program["name"]
    function = f"_{name}"
    table, values = [], []
    for path, command in walk(program):
        subs = [sub["name"] for sub in command.get("commands", [])]
        rest = "_filedir"
        for option in command["options"]:
            what = kind(option, kinds)
            if option["positional"]:
                rest = bash_reply(name, what, kinds) if what in kinds else rest
            elif what != NO_VALUE:
                reply = bash_reply(name, what, kinds)
                values += [f"    '{' '.join((*path, each)).strip()}') {reply}; return ;;" for each in option["names"]]
        table.append(f"    '{' '.join(path)}') flags='{' '.join(flags(command))}' "
                     f"commands='{' '.join(subs)}' rest={rest} ;;")
    functions = "".join(bash_values(name, value, kinds[value]) for value in used(program, kinds))
    cases = [f"      ' {' '.join(path)}' | '{' '.join(path[:-1])} {path[-1]}') path='{' '.join(path)}' ;;"
             for path, _ in walk(program) if path]
    return f"""# Completion of {name} for bash; made from the options that the program declares.
{functions}{function}() {{
  local cur prev words cword flags commands rest path='' word
  _init_completion -n = || return
  for word in "${{words[@]:1:cword-1}}"; do
    [[ $word == -* ]] && continue
    case "$path $word" in
{chr(10).join(cases)}
    esac
  done
  case "${{path:+$path }}$prev" in
{chr(10).join(values)}
  esac
  case $path in
{chr(10).join(table)}
  esac
  if [[ $cur == -* ]]; then
    COMPREPLY=($(compgen -W "$flags" -- "$cur"))
  elif [[ $commands ]]; then
    COMPREPLY=($(compgen -W "$commands" -- "$cur"))
  else
    $rest
  fi
}} &&
  complete -F {function} {name}
"""


def zsh_text(text):
    """A description inside single quotes and brackets."""
    return text.replace("\\", "\\\\").replace("[", "\\[").replace("]", "\\]").replace(":", "\\:").replace("'", "'\\''")


def zsh_values(name, value, words):
    """A function that completes one kind of value."""
    listed = " ".join(f"'{word}'" for word in words)
    add = "_sequence compadd -" if value.endswith(",...") else "compadd -S = -" if "=" in value else "compadd -"
    return f"{value_function(name, value)}() {{\n  local -a words=({listed})\n  {add} $words\n}}\n"


def zsh_option(name, option, values):
    what = kind(option, values)
    if what == NO_VALUE:
        action = ""
    elif what == FILE:
        action = ":file:_files"
    elif isinstance(what, str):
        action = f":value:{value_function(name, what)}"
    elif what:
        action = f":value:({' '.join(what)})"
    else:
        action = ":value: "
    return [f"'*{each}[{zsh_text(option['description'])}]{action}'" for each in option["names"]]


def zsh_function(name, path, command, values):
    specs = [spec for option in command["options"] if not option["positional"]
             for spec in zsh_option(name, option, values)]
    kinds = [kind(option, values) for option in command["options"] if option["positional"]]
    rest = next((value_function(name, each) for each in kinds if each in values), "_files")
    function = "_".join(("", name, *path))
    subs = command.get("commands", [])
    if not subs:
        return f"{function}() {{\n  _arguments \\\n    " + " \\\n    ".join([*specs, f"'*:value:{rest}'"]) + "\n}\n"
    described = "\n".join(f"    '{sub['name']}:{zsh_text(sub['description'])}'" for sub in subs)
    calls = "\n".join(f"        {sub['name']}) {function}_{sub['name']} ;;" for sub in subs)
    arguments = " \\\n    ".join([*specs, "'1:command:->command'", "'*::argument:->argument'"])
    return f"""{function}() {{
  local context state state_descr line
  typeset -A opt_args
  local -a commands=(
{described}
  )
  _arguments -C \\
    {arguments}
  case $state in
    command) _describe command commands ;;
    argument)
      case $line[1] in
{calls}
      esac ;;
  esac
}}
"""


def zsh(program, values):
    name = program["name"]
    functions = "\n".join([*(zsh_values(name, value, values[value]) for value in used(program, values)),
                           *(zsh_function(name, path, command, values) for path, command in walk(program))])
    return f"#compdef {name}\n# Made from the options that the program declares.\n\n{functions}\n_{name} \"$@\"\n"
