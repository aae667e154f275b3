"""stress: the table, JSON and page of a few cases, the list of all, and what it refuses."""
import json
import unittest

from program import ProgramTest


class Stress(ProgramTest):
    def test_a_case_in_every_form(self):
        result = self.succeed("stress", "--cases", "albedo,phase-sum", "--modes", "march,cone", "-o", self.path("out"))
        for text in ("march", "cone", "program", "albedo", "phase-sum", "holds", "0 fail in silence"):
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
        file = self.write("file", "")
        self.refuse(5, ["file"], "stress", "--cases", "phase-sum", "-o", file)


if __name__ == "__main__":
    unittest.main()
