"""The progress bar on a terminal: it fits the width, and nothing of it is left, however the run ends.

usage: terminal_test.py RICOCHET WORK_DIRECTORY
"""
import fcntl
import os
import pathlib
import pty
import re
import signal
import struct
import subprocess
import termios
import time
import unittest

from ricochet_case import RICOCHET, RicochetCase, WORK

SWEEP = ["sweep", "--a", "0.3", "--b", "1", "--energetic", "1", "--column", "coefficients.newton", "--threads", "1"]
AXIS = "friction.kinetic_coefficient=lin:-0.01:0.4:"


def watches(pid, number):
    """True once the process has a handler for the signal, or waits for it with the signal blocked."""
    status = pathlib.Path(f"/proc/{pid}/status").read_text()
    masks = [int(mask, 16) for mask in re.findall(r"^Sig(?:Cgt|Blk):\s*([0-9a-f]+)", status, re.MULTILINE)]
    return any(mask >> (number - 1) & 1 for mask in masks)


class Screen:
    """Holds what a terminal of so many columns shows, of the few controls that a bar needs."""

    def __init__(self, columns):
        self.columns, self.lines, self.at, self.bars = columns, [""], 0, 0

    def take(self, text):
        for part in re.findall(r"\x1b\[K|\r|\n|[^\x1b\r\n]", text):
            if part == "\x1b[K":
                self.lines[-1] = self.lines[-1][:self.at]
                self.bars += bool(self.lines[-1])
            elif part == "\r":
                self.at = 0
            elif part == "\n" or self.at == self.columns:
                self.lines.append("" if part == "\n" else part)
                self.at = len(self.lines[-1])
            else:
                line = self.lines[-1].ljust(self.at)
                self.lines[-1] = line[:self.at] + part + line[self.at + 1:]
                self.at += 1


class Terminal(RicochetCase):
    def run_on(self, columns, arguments, after_bars=None, signals=0, stdout=subprocess.DEVNULL):
        """Runs on a terminal, and sends Ctrl-C once that many bars were seen. Returns the code and the screen."""
        ours, theirs = pty.openpty()
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        screen = Screen(columns)
        process = subprocess.Popen([RICOCHET, *arguments], cwd=WORK, stdin=subprocess.DEVNULL, stderr=theirs,
                                   stdout=theirs if stdout is None else stdout)
        os.close(theirs)
        try:
            self.watch(ours, process, screen, after_bars, signals)
            return process.wait(60), screen
        finally:
            process.kill()
            os.close(ours)

    def watch(self, terminal, process, screen, after_bars, signals):
        while True:
            try:
                text = os.read(terminal, 65536).decode()
            except OSError:  # The other end is closed.
                return
            screen.take(text.replace("\r\n", "\n"))
            if after_bars is None:
                continue
            if screen.bars:
                self.assertEqual(len(screen.lines), 1, screen.lines)
            if screen.bars >= after_bars:
                for _ in range(signals):
                    process.send_signal(signal.SIGINT)
                after_bars = None

    def test_the_bar_fits_the_width_and_ctrl_c_erases_it(self):
        for columns in (12, 40, 60, 100, 200):
            with self.subTest(columns=columns):
                code, screen = self.run_on(columns, [*SWEEP, "--axis", AXIS + "1e11", "-o", f"big{columns}.csv"], 5, 1)
                self.assertEqual(code, 130)
                self.assertGreaterEqual(screen.bars, 5)
                shown = "".join(screen.lines)
                self.assertTrue(shown.startswith(f"{WORK}/big{columns}.csv.part is the first part"), screen.lines)
                self.assertNotIn("left", shown)
                self.assertNotIn("#", shown)

    def test_the_end_of_a_run_erases_the_bar_before_it_says_anything(self):
        for stdout in (subprocess.DEVNULL, None):  # None: the table comes to the terminal, too.
            code, screen = self.run_on(100, [*SWEEP, "--axis", AXIS + "1e8"], stdout=stdout)
            self.assertEqual(code, 0)
            self.assertGreaterEqual(screen.bars, 1)
            self.assertEqual([line for line in screen.lines if "points/s" in line or "#" in line], [])
            self.assertIn("points are invalid", "\n".join(screen.lines))

    def test_rows_on_the_terminal_have_no_bars_between_them(self):
        code, screen = self.run_on(100, [*SWEEP, "--axis", AXIS + "2e5", "--format", "csv"], stdout=None)
        self.assertEqual((code, screen.bars), (0, 0))

    def test_signals_end_every_command_with_130(self):
        far = [*SWEEP, "--axis", AXIS + "1e9", "--format", "csv"]  # Nobody reads what it writes.
        for arguments, number in [(["solve", "--scene", "-"], signal.SIGINT), (["solve", "--scene", "-"], signal.SIGTERM),
                                  (far, signal.SIGINT), (far, signal.SIGTERM)]:
            with self.subTest(command=arguments[0], signal=number):
                process = subprocess.Popen([RICOCHET, *arguments], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                           stderr=subprocess.PIPE,
                                           preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
                if arguments is far:
                    process.stdout.read(1)
                while not watches(process.pid, number):
                    time.sleep(0.01)
                process.send_signal(number)
                self.assertEqual(process.wait(timeout=60), 130)
                for stream in (process.stdin, process.stdout, process.stderr):
                    stream.close()

    def test_a_program_in_the_background_ignores_ctrl_c_in_every_command(self):
        short = [*SWEEP, "--axis", AXIS + "1e6", "--format", "csv"]
        for arguments in (["solve", "--scene", "-"], short):
            with self.subTest(command=arguments[0]):
                process = subprocess.Popen([RICOCHET, *arguments], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                           stderr=subprocess.PIPE,
                                           preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_IGN))
                if arguments is short:
                    process.stdout.read(1)  # It watches for signals since it has begun to write.
                while not watches(process.pid, signal.SIGTERM):
                    time.sleep(0.01)
                process.send_signal(signal.SIGINT)
                scene = b"pendulum { inertia_kg_m2: 1 a_m: 1 omega_minus_rad_s: -1 } restitution { newton: 1 }"
                process.communicate(scene if arguments is not short else None, timeout=120)
                self.assertEqual(process.returncode, 0)


if __name__ == "__main__":
    unittest.main()
