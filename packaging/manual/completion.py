"""Completions for bash and zsh: subcommands, flags, and the values of flags that are files or words."""

import re

NO_VALUE = ""
FILE = "FILE"


def kind(option):
    """Whether the value of an option is absent, a file, one of some words, or else."""
    value = option["value"]
    if not value:
        return NO_VALUE
    # "text|json|csv" names the words that are possible; "FILE.svg|.png" names files.
    if re.fullmatch(r"[a-z]+(\|[a-z]+)+", value):
        return value.split("|")
    return FILE if "FILE" in value or "PATH" in value else None


def flags(command):
    return [name for option in command["options"] if not option["positional"] for name in option["names"]]


def walk(command, path=()):
    """Yields every command below a program, with the words that lead to it."""
    yield path, command
    for sub in command.get("commands", []):
        yield from walk(sub, (*path, sub["name"]))


def bash(program):
    name = program["name"]
    function = f"_{name}"
    table, values = [], []
    for path, command in walk(program):
        subs = [sub["name"] for sub in command.get("commands", [])]
        table.append(f"    '{' '.join(path)}') flags='{' '.join(flags(command))}' commands='{' '.join(subs)}' ;;")
        for option in command["options"]:
            if option["positional"] or kind(option) == NO_VALUE:
                continue
            what = kind(option)
            reply = "_filedir" if what == FILE else f"COMPREPLY=($(compgen -W '{' '.join(what or [])}' -- \"$cur\"))"
            values += [f"    '{' '.join((*path, each)).strip()}') {reply}; return ;;" for each in option["names"]]
    return f"""# Completion of {name} for bash; made from the options that the program declares.
{function}() {{
  local cur prev words cword flags commands path='' word
  _init_completion -n = || return
  for word in "${{words[@]:1:cword-1}}"; do
    [[ $word == -* ]] && continue
    case "$path $word" in
{chr(10).join(f"      ' {' '.join(path)}' | '{' '.join(path[:-1])} {path[-1]}') path='{' '.join(path)}' ;;" for path, _ in walk(program) if path)}
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
    _filedir
  fi
}} &&
  complete -F {function} {name}
"""


def zsh_text(text):
    """A description inside single quotes and brackets."""
    return text.replace("\\", "\\\\").replace("[", "\\[").replace("]", "\\]").replace(":", "\\:").replace("'", "'\\''")


def zsh_option(option):
    what = kind(option)
    if what == NO_VALUE:
        action = ""
    elif what == FILE:
        action = ":file:_files"
    elif what:
        action = f":value:({' '.join(what)})"
    else:
        action = ":value: "
    return [f"'*{name}[{zsh_text(option['description'])}]{action}'" for name in option["names"]]


def zsh_function(name, path, command):
    specs = [spec for option in command["options"] if not option["positional"] for spec in zsh_option(option)]
    function = "_".join(("", name, *path))
    subs = command.get("commands", [])
    if not subs:
        return f"{function}() {{\n  _arguments \\\n    " + " \\\n    ".join([*specs, "'*:file:_files'"]) + "\n}\n"
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


def zsh(program):
    name = program["name"]
    functions = "\n".join(zsh_function(name, path, command) for path, command in walk(program))
    return f"#compdef {name}\n# Made from the options that the program declares.\n\n{functions}\n_{name} \"$@\"\n"
