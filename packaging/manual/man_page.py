"""Manual pages: one for a program, and one for each of its subcommands."""

import re

# Groups that CLI11 has for what is not put into one.
USUAL_GROUPS = ("Options", "OPTIONS")
LONG_LINE = 100  # A line of a footer that is longer goes on in the next.


def roff(text):
    """The text with what roff would take for commands made harmless."""
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq").replace("`", "\\(ga")
    text = text.replace("^", "\\(ha").replace("~", "\\(ti")
    return re.sub(r"^\.", r"\\&.", text, flags=re.MULTILINE)


def heading(title):
    return f".SH {roff(title).upper()}"


def option_names(option):
    value = f" \\fI{roff(option['value'])}\\fR" if option["value"] else ""
    if option["positional"]:
        return f"\\fI{roff(option['positional'])}\\fR"
    return ", ".join(f"\\fB{roff(name)}\\fR" for name in option["names"]) + value


def option_lines(options):
    lines = []
    for option in options:
        lines += [".TP", option_names(option), roff(option["description"]) or "."]
    return lines


def groups(options):
    """The titles of the groups, in their order, with their options."""
    found = {}
    for option in options:
        title = "Options" if option["group"] in USUAL_GROUPS else option["group"]
        found.setdefault(title, []).append(option)
    return found


def sentences_and_examples(footer):
    """The footer as sections: sentences that belong together, and examples as they stand."""
    lines, sentence, example = [], [], []

    def end_example():
        if example:
            lines.extend([".PP", ".nf", ".RS", *map(roff, example), ".RE", ".fi"])
            example.clear()

    for line in footer.splitlines():
        if not line:
            continue
        if line.startswith("  ") and not sentence:
            example.append(line[2:])
            continue
        end_example()
        sentence.append(line)
        if len(line) <= LONG_LINE:
            lines += [".PP", roff(" ".join(sentence))]
            sentence.clear()
    end_example()
    return lines


def environment(program):
    if program["name"] == "ricochetd":
        return ["Each option is also read from the environment: \\fBRICOCHETD_MAX_LIVE_CALLS\\fR=\\fI10\\fR stands for",
                "\\fB\\-\\-max\\-live\\-calls\\fR \\fI10\\fR."]
    return [
        "The options of the connection are also read from the environment: \\fBRICOCHET_SERVER\\fR,",
        "\\fBRICOCHET_TLS_CA\\fR, \\fBRICOCHET_TOKEN_FILE\\fR and so on. \\fBRICOCHET_TOKEN\\fR holds a token itself."
    ]


def synopsis(name, command):
    words = [f"\\fB{roff(name)}\\fR", "[\\fIOPTION\\fR]..."]
    words += [f"\\fI{roff(option['positional'])}\\fR" for option in command["options"] if option["positional"]]
    if command.get("commands"):
        words.append("\\fICOMMAND\\fR")
    return " ".join(words)


def without_empty_paragraphs(lines):
    """Leaves out the paragraphs that begin right after a heading or another paragraph, which have no effect."""
    kept = []
    for line in lines:
        if line == ".PP" and kept and (kept[-1] == ".PP" or kept[-1].startswith(".SH")):
            continue
        kept.append(line)
    return kept


def page(name, title, command, section, summary, version, program):
    lines = [
        f'.TH {roff(title).upper()} {section} "" "ricochet {version}" "Ricochet"',
        heading("Name"), f"{roff(title)} \\- {roff(summary)}",
        heading("Synopsis"), synopsis(name, command),
        heading("Description"), *[roff(line) or ".PP" for line in command["description"].splitlines()]]
    if command.get("commands"):
        lines.append(heading("Commands"))
        for sub in command["commands"]:
            lines += [".TP", f"\\fB{roff(sub['name'])}\\fR",
                      f"{roff(sub['description'])}; see \\fB{roff(title)}\\-{roff(sub['name'])}\\fR({section})"]
    for group, options in groups(command["options"]).items():
        lines += [heading(group), *option_lines(options)]
    if command["footer"]:
        lines += [heading("Examples and notes"), *sentences_and_examples(command["footer"])]
    lines += [heading("Environment"), *environment(program)]
    return "\n".join(without_empty_paragraphs(lines)) + "\n"


def pages(program, section, summary, version):
    """Yields the title and the text of the page of a program and of each command below it."""
    name = program["name"]
    yield from _pages(program, name, name, section, summary, version, program)


def _pages(command, name, title, section, summary, version, program):
    yield title, page(name, title, command, section, summary, version, program)
    for sub in command.get("commands", []):
        yield from _pages(sub, f"{name} {sub['name']}", f"{title}-{sub['name']}", section,
                          sub["description"], version, program)
