"""A real Prometheus scrapes a real ricochetd and is asked for what it read.

usage: prometheus_test.py SOURCE_DIR RICOCHETD RICOCHET WORK_DIR

Also holds the alert rules, the dashboard and the table of metrics in deploy/README.md to the metrics that there are.
Exits with 77, which ctest takes as skipped, if Prometheus is not installed.
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import time
import urllib.parse
import urllib.request

SOURCE, RICOCHETD, RICOCHET, WORK = (pathlib.Path(argument) for argument in sys.argv[1:5])
SOLVES = 7


def wait_for(what, ask, seconds=60):
    """Returns the first true answer of `ask`."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        try:
            answer = ask()
        except OSError:
            answer = None
        if answer:
            return answer
        time.sleep(0.1)
    raise SystemExit(f"no {what} within {seconds} s")


def fetch(url):
    with urllib.request.urlopen(url, timeout=10) as reply:
        return reply.read().decode()


def found(pattern, path):
    match = re.search(pattern, path.read_text()) if path.exists() else None
    return match and match.group(1)


def check(condition, message):
    if not condition:
        raise SystemExit(message)


def names_in(text):
    """The names of metrics of ours in an expression or a table."""
    return set(re.findall(r"\b((?:ricochet|grpc_server_call)_[a-z_]+)", text))


def family(name):
    return re.sub(r"_(bucket|sum|count)$", "", name)


def check_documents(metrics_page):
    exposed = set(re.findall(r"^# TYPE ((?:ricochet|grpc)_\S+)", metrics_page, re.MULTILINE))
    readme = (SOURCE / "deploy/README.md").read_text()
    table = {name for row in re.findall(r"^\| `([^`]+)`.*$", readme, re.MULTILINE) for name in names_in(row)}
    check(exposed == table, f"deploy/README.md and the page differ in {sorted(exposed ^ table)}")
    for path in ("deploy/prometheus/rules.yml", "deploy/grafana/ricochet.json"):
        expressions = " ".join(re.findall(r'expr"?: "?(.*)$', (SOURCE / path).read_text(), re.MULTILINE))
        unknown = {name for name in names_in(expressions) if family(name) not in exposed}
        check(expressions and not unknown, f"{path} asks for {sorted(unknown)}, which no server has")
    json.loads((SOURCE / "deploy/grafana/ricochet.json").read_text())


def promtool(*arguments, **options):
    subprocess.run(["promtool", *arguments], check=True, timeout=60, **options)


def query(prometheus, expression):
    reply = json.loads(fetch(f"{prometheus}/api/v1/query?" + urllib.parse.urlencode({"query": expression})))
    return [float(result["value"][1]) for result in reply["data"]["result"]]


def run(processes):
    log = WORK / "ricochetd.log"
    port_file = WORK / "port"
    processes.append(subprocess.Popen([RICOCHETD, "--listen", "127.0.0.1:0", "--port-file", port_file, "--metrics",
                                       "127.0.0.1:0", "--log-file", log, "--drain-grace", "0"]))
    wait_for("port", port_file.exists)
    metrics = "http://" + wait_for("address of the metrics", lambda: found(r" metrics address=(\S+)", log)) + "/metrics"
    solve = [RICOCHET, "solve", "--a", "0.3", "--b", "1", "--energetic", "1", "--server",
             f"127.0.0.1:{port_file.read_text().strip()}"]
    for _ in range(SOLVES):
        subprocess.run([*solve, "--mu=0.1"], check=True, stdout=subprocess.DEVNULL, timeout=60)
    subprocess.run([*solve, "--mu=-0.1"], check=False, stderr=subprocess.DEVNULL, timeout=60)

    page = fetch(metrics)
    promtool("check", "metrics", input=page, text=True)
    check_documents(page)

    (WORK / "prometheus.yml").write_text(
        "scrape_configs:\n- job_name: ricochet\n  scrape_interval: 200ms\n  scrape_timeout: 200ms\n"
        f"  static_configs:\n  - targets: ['{urllib.parse.urlparse(metrics).netloc}']\n")
    output = WORK / "prometheus.log"
    processes.append(subprocess.Popen(
        ["prometheus", f"--config.file={WORK}/prometheus.yml", f"--storage.tsdb.path={WORK}/data",
         "--web.listen-address=127.0.0.1:0", "--log.format=json"], stderr=output.open("w")))
    prometheus = "http://" + wait_for("address of Prometheus",
                                      lambda: found(r'"address":"(127\.0\.0\.1:[1-9]\d*)"', output))
    solved = 'sum(grpc_server_call_duration_seconds_count{job="ricochet",grpc_status="OK",grpc_method=~".*/Solve"})'
    wait_for("scrape", lambda: query(prometheus, solved) == [SOLVES])
    check(query(prometheus, 'ricochet_solved_total{model="pendulum"}') == [SOLVES], "picks by model")
    check(query(prometheus, 'ricochet_refusals_total{reason="INVALID_REQUEST"}') == [1], "refusals by reason")
    check(query(prometheus, "ricochet_serving") == [1], "health")
    check(query(prometheus, "count(ricochet_info)") == [1], "version")


def main():
    if not shutil.which("prometheus") or not shutil.which("promtool"):
        print("skipped: the Debian package prometheus is not installed")
        return 77
    shutil.rmtree(WORK, ignore_errors=True)
    WORK.mkdir(parents=True)
    promtool("check", "rules", SOURCE / "deploy/prometheus/rules.yml")
    promtool("test", "rules", SOURCE / "deploy/prometheus/rules_test.yml")
    processes = []
    try:
        run(processes)
    finally:
        for process in processes:
            process.terminate()
        codes = [process.wait(timeout=60) for process in processes]
    check(codes[0] == 0, f"ricochetd ended with {codes[0]}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
