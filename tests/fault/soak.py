"""Runs every check long, and writes the tables of deploy/README.md from what it measured.

usage: soak.py RICOCHETD RICOCHET WORK_DIRECTORY [MINUTES [--page PAGE] [TOPIC...]]

MINUTES are those of the mixed load, 30 by default. Fewer minutes try as much less of the bad requests and the kills;
0 runs every check short. If topics are named, only these are run, and the results of the others are taken from
WORK_DIRECTORY, where an earlier run left them. --page names a copy of deploy/README.md that is written in its place, with
the results of the topics that are named alone.
"""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parent.parent
PAGE = SOURCE / "deploy/README.md"
TOPICS = [
    "load", "overload", "places", "amplification", "transport", "boundary", "faults", "pool", "resume", "credentials",
    "garbage", "mixed"]
BEGIN, END = "<!-- written by ./dev soak -->", "<!-- end of what ./dev soak wrote -->"


# The checks start processes while gRPC has threads; its handlers of fork can wait for each other without an end.
os.environ["GRPC_ENABLE_FORK_SUPPORT"] = "0"


def run(ricochetd, ricochet, work, minutes, topic):
    """Runs a topic and leaves its results in the work directory."""
    found = work / f"{topic}.json"
    found.unlink(missing_ok=True)
    print(f"\n== {topic}", flush=True)
    subprocess.run(
        [sys.executable, HERE / f"{topic}.py", "--ricochetd", ricochetd, "--ricochet", ricochet, "--proto", SOURCE / "proto",
         "--work", work / topic, *(["--soak", "--minutes", str(minutes)] if minutes else []), "--known", "--json", found],
        check=False)
    commit_file(work, topic).write_text(commit(), encoding="ascii")


def commit_file(work, topic):
    """Where the commit stands at which a topic was run."""
    return work / f"{topic}.commit"


def commits_in(work, topics):
    """Says at which commit the topics were run, or which of them at which."""
    topics_of = {}
    for topic in topics:
        topics_of.setdefault(commit_file(work, topic).read_text(encoding="ascii"), []).append(topic)
    if len(topics_of) == 1:
        return f"commit {next(iter(topics_of))}"
    return "commits " + ", ".join(f"{name} ({', '.join(topics)})" for name, topics in topics_of.items())


def results_in(work, topics):
    results = []
    for topic in topics:
        found = work / f"{topic}.json"
        if not found.exists():
            sys.exit(f"there are no results of {topic}: run it")
        results += json.loads(found.read_text(encoding="utf-8"))
    return results


def machine():
    model = re.search(r"model name\s*: (.*)", Path("/proc/cpuinfo").read_text(encoding="ascii"))
    return f"{os.cpu_count()} cores, {model.group(1) if model else 'unknown processor'}"


def commit():
    def git(*words):
        return subprocess.run(["git", "-C", SOURCE, *words], capture_output=True, text=True, check=True).stdout.strip()

    changed = [line for line in git("status", "--porcelain", "--untracked-files=no").splitlines() if "README" not in line]
    return git("rev-parse", "--short=10", "HEAD") + (" with changes" if changed else "")


def figures_of(results, name):
    for one in results:
        if one["name"] == name and one["result"] == "level":
            return one["figures"]
    return {}


def level(results, kind):
    counted = [one for one in results if one["kind"] == kind and one["result"] != "skipped" and not one["mitigation"]]
    return sum(one["result"] == "level" for one in counted), len(counted)


def number(value, digits=3):
    if value is None:
        return "not measured"
    return f"{value:,.0f}" if abs(value) >= 1000 else f"{value:.{digits}g}"


def summary(results):
    unary, beside = figures_of(results, "unary clients"), figures_of(results, "Solves beside expensive calls")
    goodput, mixed = figures_of(results, "goodput under overload"), figures_of(results, "mixed load")
    rates = {name: value for name, value in unary.items() if name.endswith("/s")}
    best = max(rates, key=rates.get) if rates else None
    sent = sum(one["figures"].get("sent", 0) for one in results)
    rows = [
        ("load held", f"{number(rates.get(best))} Solves a second, {best.split(':')[0]} clients on the server's own cores, "
         f"every one answered; 1000 clients: {number(100 * rates['1000: /s'] / rates[best])} % of that" if best else "not measured"),
        ("p99 of a cheap Solve beside the most expensive calls of 64 clients",
         f"{number(beside.get('ratio'))} times p99 alone ({number(1e3 * beside['p99 alone s'])} ms)" if beside else "not measured"),
        ("answers a second with 8 times as many clients as cores, with deadlines",
         f"{number(100 * goodput['x8'])} % of those at capacity" if goodput else "not measured"),
        ("mixed load", f"{number(mixed.get('minutes'))} minutes, {number(mixed.get('calls'))} rounds of calls: "
         f"{number(mixed.get('MiB'))} MiB, {mixed.get('descriptors')} descriptors, {mixed.get('threads')} threads at the end"
         if mixed else "not measured"),
        ("checks of load that are level", "{} of {}".format(*level(results, "load"))),
        ("faults survived", "{} of {}".format(*level(results, "fault"))),
        ("kinds of hostile input withstood", "{} of {}".format(*level(results, "input"))),
        ("bad requests sent, and lost: ended otherwise than promised",
         f"{number(sent)}, {0 if all(one['result'] == 'level' for one in results if one['topic'] == 'garbage') else 'see the checks of messages'}"),
    ]
    return "\n".join(["| measured | result |", "| --- | --- |", *(f"| {name} | {text} |" for name, text in rows)])


def cell(text):
    return text.replace("|", "/").replace("\n", " ").replace("<", "&lt;")


def rows_of(results):
    lines = ["| tried | rule | result |", "| --- | --- | --- |"]
    for one in results:
        told = {"level": "level", "skipped": "not tried here", "not level": "**not level**"}[one["result"]]
        text = f"{told}: {cell(one['text'])}" if one["text"] else told
        if one["result"] == "not level" and one["mitigation"]:
            text += f". {cell(one['mitigation'])}"
        lines.append(f"| {cell(one['name'])} | {cell(one['rule'])} | {text} |")
    return "\n".join(lines)


def run_of(minutes):
    if minutes >= 30:
        return ""
    return f" This was a run of {minutes:g} minutes instead of 30." if minutes else " This was the short run."


def write(page, results, commits, minutes):
    text = page.read_text(encoding="utf-8")
    if BEGIN not in text or END not in text:
        sys.exit(f"{page} lacks the lines {BEGIN} and {END}")
    head = (f"Measured at {commits} on {machine()}, shared with the clients. Only the ratios carry over to other "
            f"machines.{run_of(minutes)}")
    made = f"{BEGIN}\n{head}\n\n{summary(results)}\n\n{rows_of(results)}\n{END}"
    start, rest = text.split(BEGIN, 1)
    page.write_text(start + made + rest.split(END, 1)[1], encoding="utf-8")


def main():
    arguments = sys.argv[5:]
    page, written = PAGE, TOPICS
    if arguments[:1] == ["--page"]:
        page, arguments = Path(arguments[1]), arguments[2:]
        written = arguments or TOPICS
    topics = arguments or TOPICS
    if len(sys.argv) < 4 or not set(topics) <= set(TOPICS):
        sys.exit(__doc__)
    ricochetd, ricochet, work = [Path(argument).resolve() for argument in sys.argv[1:4]]
    work.mkdir(parents=True, exist_ok=True)
    minutes = float(sys.argv[4]) if len(sys.argv) > 4 else 30
    for topic in topics:
        run(ricochetd, ricochet, work, minutes, topic)
    results = results_in(work, written)
    (work / "results.json").write_text(json.dumps(results, indent=1), encoding="utf-8")
    write(page, results, commits_in(work, written), minutes)
    bad = [one["name"] for one in results if one["result"] == "not level" and not one["mitigation"]]
    print(f"\n{len(results)} checks, {len(bad)} not level{': ' if bad else ''}{', '.join(bad)}")
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
