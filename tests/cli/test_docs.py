"""Every command in README.md and docs runs as it stands there. The long ones and those of oiiotool run with
TYNDALL_NIGHTLY=1."""
import os
import pathlib
import re
import resource
import shlex
import shutil
import subprocess
import sys
import unittest

from cli.program import SOURCE, TYNDALL, ProgramTest

# What takes longer than a few seconds on two cores, or wants a display.
LONG = re.compile(r"oiiotool|tyndall (chart|stress|verify|plan(?!.*--save)|compare)|--frames 1-|--target-error|--quality (final|reference)|--mode all|--samples [0-9]{3}|--orders all")
# "24 s" or "3 min" in the comment beside a command: about what it takes on two cores. Others are done within a few seconds.
STATED = re.compile(r"\s#\s.*?\b([0-9.]+) (s|min)\b")
UNSTATED_SECONDS, TOLERANCE = 4, 3
LONG_SECONDS = 8  # stated ones from here on are long, too
ELSEWHERE = re.compile(r"tyndall (view|COMMAND|--help)")  # the viewer has tests of its own


def pages():
    return [SOURCE / "README.md", *sorted((SOURCE / "docs").rglob("*.md"))]


def commands():
    """Page, words and stated seconds of every command line: indented by four, without comments."""
    for page in pages():
        for line in page.read_text().splitlines():
            if line.startswith(("    tyndall ", "    oiiotool ")) and not ELSEWHERE.search(line):
                stated = STATED.search(line)
                seconds = float(stated[1]) * (60 if stated[2] == "min" else 1) if stated else None
                yield page.name, shlex.split(re.split(r"\s#\s", line)[0]), seconds


def processor_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Docs(ProgramTest):
    def setUp(self):
        super().setUp()
        self.path("out").mkdir()
        for name in ("scenes", "volumes", "docs"):
            os.symlink(SOURCE / name, self.path(name))

    def run_commands(self, long):
        """The quick ones; with the long ones, which use what those write, all of them."""
        found = [command for command in commands()
                 if long or not (LONG.search(" ".join(command[1])) or (command[2] or 0) > LONG_SECONDS)]
        self.assertGreater(len(found), 5)
        for page, words, stated in found:
            before = processor_seconds()
            result = subprocess.run([TYNDALL if words[0] == "tyndall" else words[0], *words[1:]], cwd=self.directory, capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, f"{page}: {' '.join(words)}\n{result.stderr}")
            on_two_cores = (processor_seconds() - before) / 2  # whatever else the machine does
            self.assertLess(on_two_cores, TOLERANCE * (stated or UNSTATED_SECONDS) + 1, f"{page}: {' '.join(words)}")

    def test_long_commands_have_their_times_beside_them(self):
        for page, words, stated in commands():
            command = " ".join(words)
            if re.search(r"--target-error|--quality (final|reference)|--samples [0-9]{3}|tyndall (chart|stress|verify|plan(?!.*--save))", command) and "--resume" not in command:
                self.assertIsNotNone(stated, f"{page}: {command}")

    def test_files_that_commands_read_are_there(self):
        for page, words, _ in commands():
            for word in words[1:]:
                if not word.startswith("out/") and re.fullmatch(r"[\w./]+/[\w.]+\.(json|glb|vdb|txt)", word):
                    self.assertTrue((SOURCE / word).exists(), f"{page}: {word}")
        for page in pages():  # and those of the viewer, which is tested elsewhere
            for file in re.findall(r"^    tyndall view .*--script (\S+)", page.read_text(), re.M):
                self.assertTrue((SOURCE / file).exists(), f"{page.name}: {file}")

    def test_quick_commands(self):
        self.run_commands(False)

    @unittest.skipUnless(os.environ.get("TYNDALL_NIGHTLY"), "long: set TYNDALL_NIGHTLY=1")
    def test_long_commands(self):
        self.run_commands(True)

    def test_the_status_of_the_job_and_command_lines_of_other_engines(self):
        text = (SOURCE / "docs/farm.md").read_text()
        [status] = re.findall(r"^```bash\n(.*?)^```", text, re.M | re.S)
        for words in [words for _, words, _ in commands() if words[:2] == ["tyndall", "submit"]]:
            self.succeed(*words[1:], cwd=self.directory)
        asked = self.succeed("submit", "openjd", "scenes/window.json", "--frames", "1001-1024", "--parts", "3", "--samples", "2",
                             "-o", "out/pasted", cwd=self.directory)
        places = {**os.environ, "PATH": f"{pathlib.Path(TYNDALL).parent}:{os.environ['PATH']}"}
        told = subprocess.run(["bash", "-c", status], cwd=self.directory, env=places, capture_output=True, text=True)
        self.assertEqual(told.returncode, 1, told.stderr + asked.stderr)
        self.assertIn("finished: 0 of 24 frames", told.stdout)
        pasted = re.findall(r"^(?:Deadline 10|Tractor) .*?(render --plan .*?--resume)", text, re.M)
        self.assertEqual(len(pasted), 2)
        for command in pasted:  # one frame of each, small
            words = shlex.split(re.sub(r"--frames \S+", "--frames 1001", command).replace("out/shot/", "out/pasted/"))
            self.succeed(*words, cwd=self.directory)
        self.assertEqual(len(list(self.path("out/pasted/parts").iterdir())), 1)

    @unittest.skipUnless(os.environ.get("TYNDALL_NIGHTLY"), "long: set TYNDALL_NIGHTLY=1")
    @unittest.skipUnless(shutil.which("xvfb-run"), "xvfb-run is not installed")
    def test_scripts_of_the_viewer(self):
        scripts = re.findall(r"^    tyndall (view .*--script \S+)", (SOURCE / "docs/viewer.md").read_text(), re.M)
        self.assertGreater(len(scripts), 1)
        for words in scripts:
            subprocess.run(["xvfb-run", "-a", "-s", "-screen 0 1280x800x24", TYNDALL, *words.split()], cwd=self.directory,
                           check=True, capture_output=True, timeout=300)

    def test_each_picture_stands_beside_its_command(self):
        made = set(re.findall(r" #(?: .*)? docs/images/(\S+)$", "".join(page.read_text() for page in pages()), re.M))
        for page in pages():
            text = page.read_text()
            for name in re.findall(r"!\[[^]]*\]\([^)]*images/([^)]+)\)", text):
                if name.startswith("published_"):
                    self.assertIn("CC0", text, f"{page.name}: whose is {name}?")
                    continue
                script = re.match(r"(chart|architecture|accuracy)", name)
                command = script and "\n    python3 docs/make_" + script[1]
                self.assertTrue(name in made or (command and command in text), f"{page.name}: what makes {name}?")

    def check_written(self, *command):
        result = subprocess.run([sys.executable, *command, "--check"], capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_references_are_those_of_the_tables(self):
        self.check_written(SOURCE / "docs/make_reference.py", TYNDALL)

    def test_the_architecture_is_that_of_the_includes(self):
        self.check_written(SOURCE / "docs/make_architecture.py")

    def test_the_quoted_ray_is_what_explain_prints(self):
        text = (SOURCE / "docs/measuring.md").read_text()
        command, output = re.search(r"^    tyndall (explain .*?)\s+#[^\n]*\n\n(.*?)\n\n", text, re.M | re.S).groups()
        words, quoted = shlex.split(command), output.splitlines()
        printed = self.succeed(words[0], SOURCE / words[1], *words[2:4]).stdout.splitlines()
        self.assertGreater(len(quoted), 8)
        for line in quoted:
            if line.strip() not in ("", "..."):
                self.assertIn(line[4:], printed)

    def test_links_and_pictures_are_there(self):
        for page in pages():
            for target in re.findall(r"\]\(([^)#]+)[^)]*\)", page.read_text()):
                if not target.startswith("http"):
                    self.assertTrue((page.parent / target).exists(), f"{page.name}: {target}")


if __name__ == "__main__":
    unittest.main()
