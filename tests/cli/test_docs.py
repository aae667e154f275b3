"""Every command in README.md and docs runs as it stands there. The long ones run with TYNDALL_NIGHTLY=1."""
import os
import re
import subprocess
import sys
import unittest

from program import SOURCE, TYNDALL, ProgramTest

# What takes longer than a few seconds on two cores, or wants a display.
LONG = re.compile(r"tyndall (bake|chart|stress|verify|plan|compare)|--frames 1-|--target-error|--quality (final|reference)|--mode all|--orders all")
ELSEWHERE = re.compile(r"tyndall (view|COMMAND|--help)")  # the viewer has tests of its own


def pages():
    return [SOURCE / "README.md", *sorted((SOURCE / "docs").rglob("*.md"))]


def commands():
    """Page and words of every command line: indented by four, without comments."""
    for page in pages():
        for line in page.read_text().splitlines():
            if line.startswith("    tyndall ") and not ELSEWHERE.search(line):
                yield page.name, re.split(r"\s#\s", line)[0].split()


class Docs(ProgramTest):
    def setUp(self):
        super().setUp()
        for name in ("scenes", "volumes"):
            os.symlink(SOURCE / name, self.path(name))

    def run_commands(self, long):
        found = [(page, words) for page, words in commands() if bool(LONG.search(" ".join(words))) == long]
        self.assertGreater(len(found), 5)
        for page, words in found:
            result = subprocess.run([TYNDALL, *words[1:]], cwd=self.directory, capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, f"{page}: {' '.join(words)}\n{result.stderr}")

    def test_quick_commands(self):
        self.run_commands(False)

    @unittest.skipUnless(os.environ.get("TYNDALL_NIGHTLY"), "long: set TYNDALL_NIGHTLY=1")
    def test_long_commands(self):
        self.run_commands(True)

    def check_written(self, *command):
        result = subprocess.run([sys.executable, *command, "--check"], capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_references_are_those_of_the_tables(self):
        self.check_written(SOURCE / "docs/make_reference.py", TYNDALL)

    def test_the_architecture_is_that_of_the_includes(self):
        self.check_written(SOURCE / "docs/make_architecture.py")

    def test_links_and_pictures_are_there(self):
        for page in pages():
            for target in re.findall(r"\]\(([^)#]+)[^)]*\)", page.read_text()):
                if not target.startswith("http"):
                    self.assertTrue((page.parent / target).exists(), f"{page.name}: {target}")


if __name__ == "__main__":
    unittest.main()
