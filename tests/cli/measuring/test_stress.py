"""stress: the table, JSON and page of a few cases, the list of all, and what it refuses."""
import json
import signal
import subprocess
import time
import unittest

from cli.program import TYNDALL, ProgramTest


class Stress(ProgramTest):
    def test_a_case_in_every_form(self):
        result = self.succeed("stress", "--cases", "albedo,phase-sum", "--modes", "march,cone", "-o", self.path("out"), "--progress", "none")
        for text in ("march", "cone", "program", "albedo", "phase-sum", "holds", "0 fail silently"):
            self.assertIn(text, result.stdout)
        self.assertEqual((self.path("out") / "stress.txt").read_text(), result.stdout)
        report = json.loads((self.path("out") / "stress.json").read_text())
        self.assertEqual(report["fails"], 0)
        self.assertEqual([case["case"] for case in report["cases"]], ["albedo", "phase-sum"])
        self.assertEqual([r["mode"] for r in report["cases"][0]["results"]], ["march", "cone"])
        for point in report["cases"][0]["results"][0]["points"]:
            self.assertLessEqual(point["error"], point["allowed"])
        page = (self.path("out") / "stress.html").read_text()
        self.assertIn("albedo", page)
        self.assertNotIn("http", page)

    def test_a_stop_keeps_what_is_finished_and_a_resumed_run_goes_on(self):
        out = self.path("out")
        command = ["stress", "--modes", "march,cone", "-o", out]
        process = subprocess.Popen([TYNDALL, *map(str, command)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        while not (out / "stress.json").exists():
            self.assertIsNone(process.poll(), "it ends before a case is finished")
            time.sleep(0.01)
        process.send_signal(signal.SIGTERM)
        self.assertIn("finished cases are kept, --resume continues", process.communicate(timeout=60)[1])
        self.assertEqual(process.returncode, 128 + signal.SIGTERM)
        stopped = json.loads((out / "stress.json").read_text())
        finished = [case["case"] for case in stopped["cases"]]
        self.assertLess(0, len(finished))
        self.assertLess(len(finished), stopped["asked"])
        summary = f"{len(finished)} of {stopped['asked']} cases"
        self.assertIn(summary, (out / "stress.txt").read_text())
        self.assertIn(summary, (out / "stress.html").read_text())

        # The finished case is not run again: what its file says of it comes back, a changed time too.
        stopped["cases"][0]["results"][0]["seconds"] = 12345
        (out / "stress.json").write_text(json.dumps(stopped))
        few = ["--cases", finished[0] + ",phase-sum"]
        self.succeed(*command, *few, "--resume")
        cases = {case["case"]: case for case in json.loads((out / "stress.json").read_text())["cases"]}
        self.assertEqual(cases.pop(finished[0]), stopped["cases"][0])
        self.assertIn("phase-sum", cases)
        # Without --resume, or with another mode, it is.
        self.succeed("stress", "--modes", "march", "-o", out, "--cases", finished[0])
        self.succeed(*command, "--cases", finished[0], "--resume")
        [case] = json.loads((out / "stress.json").read_text())["cases"]
        self.assertEqual([result["mode"] for result in case["results"]], ["march", "cone"])
        self.assertLess(case["results"][0]["seconds"], 12345)

    def test_a_limit_is_said(self):
        report = json.loads(self.succeed("stress", "--cases", "slit", "--modes", "cone", "--json", "-q").stdout)
        result = report["cases"][0]["results"][0]
        self.assertEqual(result["verdict"], "degrades")
        point = next(p for p in result["points"] if p["value"] == result["from"])
        self.assertGreater(point["error"], point["allowed"])
        self.assertIn("shadows", point["warning"])

    def test_the_list_names_cases(self):
        listed = self.succeed("stress", "--list").stdout
        self.assertIn("mirror-cone", listed)
        self.assertIn("half angle 5, 20, 45, 70 degrees", listed)
        self.assertNotIn("mirror-cone", self.succeed("stress", "--list", "--cases", "shadows").stdout)

    def test_refusals(self):
        self.refuse(2, ["--cases", "no-such"], "stress", "--cases", "no-such-case")
        self.refuse(2, ["no mode"], "stress", "--modes", "nope")
        self.refuse(2, ["--modes"], "stress", "--modes", "cone", "--cases", "sun-behind")
        self.refuse(2, ["--resume", "--output"], "stress", "--cases", "phase-sum", "--resume")
        file = self.write("file", "")
        self.refuse(5, ["file"], "stress", "--cases", "phase-sum", "-o", file)


if __name__ == "__main__":
    unittest.main()
