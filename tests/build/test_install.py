"""What `cmake --install` puts into an empty prefix: runs from there, names no folder of the build, is small, and says so on
a processor that is too old."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

BUILD = pathlib.Path(os.environ["TYNDALL_BUILD_DIR"])
SOURCE = pathlib.Path(os.environ["TYNDALL_SOURCE_DIR"])
LARGEST = 12_000_000  # bytes a stripped program may have
CACHE = (BUILD / "CMakeCache.txt").read_text()
SANITIZED = "TYNDALL_SANITIZE:STRING=\n" not in CACHE
EMULATOR = shutil.which("qemu-x86_64")


class Install(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = pathlib.Path(tempfile.mkdtemp(prefix="tyndall_install_"))
        cls.addClassCleanup(shutil.rmtree, cls.directory, ignore_errors=True)
        cls.prefix = cls.directory / "prefix"
        subprocess.run(["cmake", "--install", BUILD, "--prefix", cls.prefix], check=True, capture_output=True)
        cls.programs = sorted((cls.prefix / "bin").iterdir())

    def test_holds_programs_scenes_volumes_and_texts(self):
        self.assertIn("tyndall", [program.name for program in self.programs])
        for name in ["share/tyndall/scenes/window.json", "share/tyndall/scenes/window.glb",
                     "share/tyndall/volumes/drifting_dust.json", "share/doc/tyndall/README.md", "share/doc/tyndall/LICENSE"]:
            self.assertTrue((self.prefix / name).is_file(), name)

    def test_renders_every_installed_scene_from_an_empty_folder(self):
        scenes = [file for file in sorted((self.prefix / "share/tyndall/scenes").iterdir())
                  if file.suffix in (".json", ".glb") and not file.name.endswith(".schema.json")]
        self.assertGreater(len(scenes), 6)
        for scene in scenes:
            picture = self.directory / f"{scene.name}.exr"
            result = subprocess.run(
                [self.prefix / "bin/tyndall", "render", scene, "-o", picture, "--frames", "1", "--res", "64x36",
                 "--quality", "draft"],
                capture_output=True, text=True, cwd=self.directory, env={"PATH": "/usr/bin:/bin"})
            self.assertEqual(result.returncode, 0, f"{scene.name}: {result.stderr}")
            self.assertGreater(picture.stat().st_size, 1000, scene.name)

    def test_names_no_folder_of_the_build(self):
        for program in self.programs:
            content = program.read_bytes()
            for folder in {BUILD, SOURCE, BUILD.resolve(), SOURCE.resolve()}:
                self.assertNotIn(str(folder).encode(), content, program)

    @unittest.skipIf(SANITIZED, "sanitizers make programs large")
    def test_is_small(self):
        for program in self.programs:
            self.assertLessEqual(program.stat().st_size, LARGEST, program)

    @unittest.skipUnless("CMAKE_BUILD_TYPE:STRING=Release\n" in CACHE, "other builds keep them")
    def test_has_no_symbols_left(self):
        for program in self.programs:
            self.assertNotIn(b".symtab", program.read_bytes(), program)

    @unittest.skipUnless(EMULATOR, "qemu-user is not installed")
    @unittest.skipIf(SANITIZED, "sanitizers start before any code of ours")
    def test_ends_with_one_line_on_an_old_processor(self):
        for program in self.programs:
            result = subprocess.run([EMULATOR, "-cpu", "Nehalem", program, "--version"], capture_output=True, text=True)
            self.assertEqual(result.returncode, 69, result.stderr)
            lines = result.stderr.splitlines()
            self.assertEqual(len(lines), 1, result.stderr)
            self.assertIn("this processor is too old", lines[0])


unittest.main()
