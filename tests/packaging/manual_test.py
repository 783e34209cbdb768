"""Help, manual pages and completions of the programs. usage: manual_test.py RICOCHET RICOCHETD MANUAL_DIRECTORY"""

import re
import subprocess
import sys
import unittest
from pathlib import Path

MANUAL, RICOCHETD, RICOCHET = Path(sys.argv.pop()), sys.argv.pop(), sys.argv.pop()
COLUMNS = 80


def run(*command, text=None):
    return subprocess.run(command, input=text, capture_output=True, text=True, check=False)


def help_of(*command):
    return run(*command, "--help").stdout


def subcommands(*of):
    """The subcommands of the program, or of one of its subcommands."""
    listed = help_of(RICOCHET, *of).partition("Subcommands:\n")[2].partition("\n\n")[0]
    return re.findall(r"^  ([a-z]+) ", listed, re.MULTILINE)


def all_subcommands():
    """Every subcommand as the list of its words."""
    return [words for name in subcommands() for words in ([name], *([name, below] for below in subcommands(name)))]


def flags_in(text):
    return set(re.findall(r"(?:^  |,)(--?[a-z][a-z-]*)", text, re.MULTILINE))


def completions(program, *words):
    """Returns what bash offers for the last of the words."""
    script = f"""
      source /usr/share/bash-completion/bash_completion
      source {MANUAL}/bash/{program}
      COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); COMP_LINE="$*"; COMP_POINT=${{#COMP_LINE}}
      _{program}
      printf '%s\\n' "${{COMPREPLY[@]}}" """
    done = run("bash", "--norc", "-c", script, "bash", program, *words)
    assert not done.stderr, done.stderr
    return set(done.stdout.split())


class Help(unittest.TestCase):
    def test_every_line_fits_into_80_columns(self):
        for name in subcommands():
            for line in help_of(RICOCHET, name).splitlines():
                self.assertLessEqual(len(line), COLUMNS, f"{name}: {line}")

    def test_every_subcommand_shows_a_worked_example(self):
        self.assertGreaterEqual(len(subcommands()), 8)
        for name in subcommands():
            self.assertRegex(help_of(RICOCHET, name), rf"(?m)^  [$>]( .*)? ricochet {name}\b", name)

    def test_options_that_exclude_several_name_them_in_order(self):
        # CLI11 keeps them in a set of addresses, whose order differs from run to run.
        lines = [line.split("Excludes: ")[1].split()
                 for name in subcommands() for line in help_of(RICOCHET, name).splitlines() if "Excludes: " in line]
        self.assertGreaterEqual(sum(len(names) > 1 for names in lines), 6)
        for names in lines:
            self.assertEqual(names, sorted(names))

    def test_the_words_of_other_programs_ask_for_it(self):
        self.assertEqual(run(RICOCHET, "help").stdout, help_of(RICOCHET))
        self.assertEqual(run(RICOCHET, "help", "solve").stdout, help_of(RICOCHET, "solve"))
        self.assertEqual(run(RICOCHET, "help", "scene", "list").stdout, help_of(RICOCHET, "scene", "list"))
        for word in ("version", "-V"):
            self.assertEqual(run(RICOCHET, word).stdout, run(RICOCHET, "--version").stdout)
        self.assertIn("ricochet 0.", run(RICOCHET, "version").stdout)


class ManualPages(unittest.TestCase):
    def pages(self):
        pages = sorted(MANUAL.glob("man?/*"))
        self.assertEqual(
            {path.name for path in pages},
            {"ricochet.1", "ricochetd.8", *(f"ricochet-{'-'.join(words)}.1" for words in all_subcommands())})
        return pages

    def test_they_render_without_warnings(self):
        for path in self.pages():
            with self.subTest(path.name):
                done = run("groff", "-ww", "-man", "-Tutf8", "-K", "utf8", "-P-c", str(path))
                self.assertEqual(done.stderr, "")
                self.assertTrue(done.stdout)
                lint = run("mandoc", "-T", "lint", "-W", "warning", str(path))
                # A page that is made anew with each build has no date.
                complaints = [line for line in lint.stdout.splitlines() if "missing date" not in line]
                self.assertEqual(complaints, [])

    def test_they_show_every_flag_of_the_help(self):
        for words in all_subcommands():
            page = run("mandoc", "-T", "ascii", str(MANUAL / f"man1/ricochet-{'-'.join(words)}.1")).stdout
            page = re.sub(".\b", "", page)
            flags = flags_in(help_of(RICOCHET, *words))
            self.assertGreaterEqual(len(flags), 2)
            self.assertEqual([flag for flag in flags if flag not in page], [], words)

    def test_examples_stand_as_they_are_typed(self):
        page = re.sub(".\b", "", run("mandoc", "-T", "utf8", str(MANUAL / "man1/ricochet-solve.1")).stdout)
        self.assertIn("$ ricochet solve --a 0.3 --b 1 --mu 0.1 --energetic 1", page)

    def test_the_daemon_has_its_options(self):
        page = re.sub(".\b", "", run("mandoc", "-T", "ascii", str(MANUAL / "man8/ricochetd.8")).stdout)
        self.assertEqual([flag for flag in flags_in(help_of(RICOCHETD)) if flag not in page], [])


class BashCompletion(unittest.TestCase):
    def test_subcommands(self):
        self.assertEqual(completions("ricochet", ""), set(subcommands()))
        self.assertEqual(completions("ricochet", "so"), {"solve"})

    def test_flags_are_those_of_the_subcommand(self):
        for name in subcommands():
            self.assertEqual(completions("ricochet", name, "--"),
                             {flag for flag in flags_in(help_of(RICOCHET, name)) if flag.startswith("--")}, name)

    def test_flags_after_other_arguments(self):
        self.assertEqual(completions("ricochet", "solve", "--a", "0.3", "--energ"), {"--energetic"})

    def test_words_that_a_flag_takes(self):
        self.assertEqual(completions("ricochet", "sweep", "--format", ""), {"text", "json", "jsonl", "csv", "npy", "netcdf"})

    def test_words_stand_for_systems_effects_and_paths(self):
        systems = set(run(RICOCHET, "scene", "list").stdout.split("\n"))
        systems = {line.split()[0] for line in systems if re.match("[a-z]", line)}
        self.assertGreaterEqual(len(systems), 7)
        self.assertEqual(completions("ricochet", "scene", "template", ""), systems)
        self.assertEqual(completions("ricochet", "scene", "template", "lin"), {"linkage"})
        for flag in ("--require", "--exclude"):
            self.assertEqual(completions("ricochet", "solve", flag, "finite-"), {"finite-duration", "finite-forces"})
        self.assertEqual(completions("ricochet", "solve", "--exclude", "friction,fin"),
                         {"friction,finite-duration", "friction,finite-forces"})

    def test_axes_and_columns_are_those_of_every_system(self):
        for system in ("pendulum", "linkage", "body_pair", "spatial_contact"):
            with self.subTest(system):
                scene = run(RICOCHET, "scene", "template", system).stdout
                axes = set(run(RICOCHET, "sweep", "--scene", "-", "--axis", "?", text=scene).stdout.split())
                columns = set(run(RICOCHET, "sweep", "--scene", "-", "--column", "?", text=scene).stdout.split())
                self.assertLessEqual({f"{path}=" for path in axes}, completions("ricochet", "sweep", "--axis", ""))
                self.assertLessEqual(columns, completions("ricochet", "sweep", "--column", ""))
        self.assertEqual(completions("ricochet", "bounds", "--range", "pendulum.a"), {"pendulum.a_m="})
        self.assertEqual(completions("ricochet", "sweep", "--axis", "pendulum.a_m=0"), set())
        for command in ("solve", "sweep", "plot"):
            self.assertEqual(completions("ricochet", command, "--column", "coefficients.newton,coefficients.p"),
                             {"coefficients.newton,coefficients.poisson"})

    def test_files(self):
        self.assertIn(str(MANUAL / "bash"), completions("ricochet", "solve", "--scene", str(MANUAL / "ba")))

    def test_the_daemon(self):
        self.assertEqual(completions("ricochetd", "--drain-"), {"--drain-grace", "--drain-timeout"})


class ZshCompletion(unittest.TestCase):
    def test_zsh_reads_it(self):
        for program in ("ricochet", "ricochetd"):
            done = run("zsh", "-f", "-n", str(MANUAL / f"zsh/_{program}"))
            self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_each_subcommand_has_a_function(self):
        text = (MANUAL / "zsh/_ricochet").read_text()
        for name in subcommands():
            self.assertIn(f"_ricochet_{name}() {{", text)
            self.assertIn(f"{name}) _ricochet_{name} ;;", text)

    def test_values_have_functions(self):
        text = (MANUAL / "zsh/_ricochet").read_text()
        for name in set(re.findall(r":value:(_ricochet_\w+)", text)):
            self.assertIn(f"{name}() {{", text)
        self.assertRegex(text, r"'\*--exclude\[.*:value:_ricochet_effect_word'")
        self.assertRegex(text, r"'\*--axis\[.*:value:_ricochet_path_word'")


if __name__ == "__main__":
    unittest.main()
