"""Sweeps whose servers or clients die: what arrives in the end has the bytes of an undisturbed run."""

import functools
import re
import signal
import subprocess
import threading
import time

from framework import Process, Server, Skipped, check, command_line, main, remove, require, tools, wait_until

ELASTIC = ["--a", "0.35", "--b", "1.1", "--mu", "0.12", "--energetic", "0.95"]
TRY_AGAIN = 75


def sweep(points):
    return ["sweep", *ELASTIC, "--axis", f"pendulum.b_m=lin:0.5:2:{points}", "--column", "coefficients.newton", "--format",
            "csv"]


@functools.lru_cache(maxsize=2)
def undisturbed(points):
    """The bytes that the embedded solver writes for sweep(points)."""
    if "--resume" not in command_line("sweep", "--help").stdout:
        raise Skipped("this command line has no --resume")
    out = tools().work / "embedded.csv"
    remove(out)
    done = command_line(*sweep(points), "-o", out, timeout_s=300)
    require(done.returncode == 0, f"the embedded run ended with {done.returncode}: {done.stderr}")
    return out.read_bytes()


class Client:
    """`ricochet sweep` into a file, as often as it takes."""

    def __init__(self, name, arguments, addresses):
        self.out = tools().work / f"{name}.csv"
        self.part = self.out.with_name(self.out.name + ".part")
        remove(self.out)
        self.command = [tools().ricochet, *arguments, "--server", ",".join(addresses), "-o", self.out]
        self.process = None
        self.runs = 0

    def start(self):
        more = ["--resume"] if self.part.exists() else []
        self.process = Process([*self.command, *more], stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
        self.runs += 1

    def error(self):
        return self.process.child.stderr.read()[-400:]

    def ended(self):
        return self.process.child.poll()

    def require_same(self, expected):
        require(self.out.read_bytes() == expected, "the bytes differ from those of an undisturbed run")
        require(not self.part.exists(), f"{self.part.name} is left")


@check("a server killed by SIGKILL at random chunks", "the client, or --resume after it gave up, ends with the bytes of an undisturbed "
       "run; 100 times in the long run of 30 minutes")
def killed_servers():
    rng = tools().random("kills")
    wanted = max(3, round(100 * tools().part)) if tools().soak else 3
    points = 3000000 if tools().soak else 1000000
    arguments, expected = sweep(points), undisturbed(points)
    kills = runs = sweeps = 0
    until = time.monotonic() + (1500 if tools().soak else 150)
    while kills < wanted:
        server = Server()
        client = Client("killed_servers", arguments, [server.address])
        client.start()
        while True:
            time.sleep(rng.uniform(0.05, 0.7))
            code = client.ended()
            if code == 0:
                break
            require(time.monotonic() < until, f"after {kills} kills there is no end in sight")
            if code is not None:
                require(code == TRY_AGAIN, f"the client ended with {code}: {client.error()}")
                client.start()
                continue
            if kills < wanted:
                server.kill()
                kills += 1
                server = Server(port=server.port)
        client.require_same(expected)
        runs += client.runs
        sweeps += 1
        server.kill()
    return {"kills": kills, "sweeps": sweeps, "runs of the client": runs, "bytes of each": len(expected)}


@check("two servers, one dying and returning", "the client ends with 0 and the bytes of an undisturbed run, and goes on by itself")
def two_servers():
    points = 2000000 if tools().soak else 1000000
    arguments, expected = sweep(points), undisturbed(points)
    servers = [Server(drain_grace=0.2), Server(drain_grace=0.2)]
    ports = [server.port for server in servers]
    client = Client("two_servers", arguments, [server.address for server in servers])
    client.start()
    changes = 0
    while client.ended() is None and changes < (20 if tools().soak else 4):
        time.sleep(0.4)
        which = changes % 2
        if changes % 4 < 2:
            servers[which].kill()
        else:
            servers[which].signal(signal.SIGTERM)
            servers[which].wait(15)
            servers[which].kill()
        servers[which] = Server(port=ports[which], drain_grace=0.2)
        changes += 1
    code = client.process.wait(120)
    require(code == 0, f"the client ended with {code}: {client.error()}")
    client.require_same(expected)
    for server in servers:
        server.kill()
    return {"servers ended": changes, "bytes": len(expected)}


@check("the summary after a resume", "it is that of an undisturbed run")
def same_summary():
    points = 20000000 if tools().soak else 1500000
    arguments = ["sweep", *ELASTIC, "--axis", f"pendulum.b_m=lin:0.5:2:{points}", "--axis", "friction.kinetic_coefficient=0,0.3,4",
                 "--column", "coefficients.newton", "--summary-only"]

    def text(done):
        require(done.returncode == 0, f"ended with {done.returncode}: {done.stderr}")
        return re.sub(r"[0-9.e+-]+ s\b", "ELAPSED s", done.stdout)

    servers = [Server(), Server()]
    expected = text(command_line(*arguments, "--server", servers[0].address, timeout_s=300))
    result = []
    asked = threading.Thread(target=lambda: result.append(command_line(
        *arguments, "--server", ",".join(server.address for server in servers), timeout_s=300)))
    before = servers[0].cpu_s()
    asked.start()
    # It dies once it has computed for a while, in the middle of the sweep.
    require(wait_until(lambda: servers[0].cpu_s() > before + 0.03, 60, 0.01), "the server computes nothing")
    servers[0].kill()
    asked.join()
    found = text(result[0])
    servers[1].kill()
    require(found == expected, f"{found} is not {expected}")
    return {}


def wait_for_bytes(client):
    """Waits until the client has written a part of its file."""
    until = time.monotonic() + 20
    while not (client.part.exists() and client.part.stat().st_size > 1 << 16):
        require(time.monotonic() < until, "the client writes no partial file")
        time.sleep(0.01)


def ended_client(name, number, codes):
    points = 3000000 if tools().soak else 2000000
    arguments, expected = sweep(points), undisturbed(points)
    with Server() as server:
        client = Client(name, arguments, [server.address])
        client.start()
        wait_for_bytes(client)
        client.process.signal(number)
        code = client.process.wait(20)
        require(code in codes, f"the client ended with {code}: {client.error()}")
        require(client.part.exists() and not client.out.exists(), "there is no partial file, or a whole one")
        held = client.part.stat().st_size
        client.start()
        code = client.process.wait(120)
        require(code == 0, f"--resume ended with {code}: {client.error()}")
        client.require_same(expected)
        return {"bytes kept": held, "bytes": len(expected)}


@check("a client killed by SIGKILL, and --resume", "the file has the bytes of an undisturbed run")
def killed_client():
    return ended_client("killed_client", signal.SIGKILL, (-signal.SIGKILL,))


@check("a client ended by SIGINT, and --resume", "it says so by its exit code, and the file has the bytes of an undisturbed run")
def interrupted_client():
    return ended_client("interrupted_client", signal.SIGINT, (130, -signal.SIGINT))


@check("a partial file that was changed", "--resume refuses it, or ends with the bytes of an undisturbed run")
def changed_partial():
    rng = tools().random("partial")
    points = 3000000 if tools().soak else 2000000
    arguments, expected = sweep(points), undisturbed(points)
    with Server() as server:
        answers = []
        for how in ("cut", "flipped", "emptied"):
            client = Client("changed_partial", arguments, [server.address])
            client.start()
            wait_for_bytes(client)
            client.process.signal(signal.SIGKILL)
            client.process.wait(20)
            data = bytearray(client.part.read_bytes())
            if how == "cut":
                del data[len(data) // 2:]
            elif how == "flipped":
                data[rng.randrange(len(data))] ^= 1
            else:
                data.clear()
            client.part.write_bytes(data)
            client.start()
            code = client.process.wait(120)
            require(code is not None, f"{how}: --resume does not end")
            answers.append(f"{how} {code}")
            if code == 0:
                require(client.out.read_bytes() == expected, f"{how}: --resume ended with 0 and other bytes")
        return {"exit codes": answers}


if __name__ == "__main__":
    main()
