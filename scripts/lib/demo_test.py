"""The demo chooses sensibly and judges hits by the rule that it states."""

import contextlib
import io
import json
import pathlib
import tempfile
import unittest

import demo_plan
import demo_table


class DemoTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

    def touch(self, *names):
        for name in names:
            (self.root / name).touch()

    def run_quietly(self, main, *arguments):
        output = io.StringIO()
        with contextlib.redirect_stdout(output):
            main(*arguments)
        return output.getvalue()


class PlanTest(DemoTest):
    def test_class_and_actors_come_from_names_where_there_is_no_list(self):
        self.touch("HDM_bd_clap5Reps_001_120.amc", "HDM_bk_clap5Reps_002_120.amc",
                   "HDM_dg_clap5Reps_003_120.AMC", "HDM_bd_kickLFront1Reps_001_120.amc",
                   "HDM_dg_01-02_03_120.amc", "HDM_bd_01-02_03_120.amc")
        planned = self.run_quietly(demo_plan.main, self.root, self.root)
        self.assertEqual(planned.splitlines(), [str(self.root / "clips.csv"), "clap5Reps", "bd,bk"])
        self.assertEqual([pathlib.Path(line).name for line in
                          (self.root / "searched.txt").read_text().splitlines()],
                         ["HDM_dg_01-02_03_120.amc", "HDM_dg_clap5Reps_003_120.AMC"])

    def test_a_list_is_taken_as_it_is(self):
        self.touch("one.amc", "two.amc", "other.amc")
        (self.root / "clips.csv").write_text(
            "file,class,actor\none.amc,squat1Reps,x\ntwo.amc,squat1Reps,y\n")
        planned = self.run_quietly(demo_plan.main, self.root, self.root)
        self.assertEqual(planned.splitlines()[1:], ["squat1Reps", "x"])

    def test_one_person_is_not_enough(self):
        self.touch("HDM_bd_clap5Reps_001_120.amc", "HDM_bd_clap5Reps_002_120.amc")
        with self.assertRaisesRegex(SystemExit, "two people or more"):
            demo_plan.main(self.root, self.root)


class TableTest(DemoTest):
    def test_every_stretch_is_found_once(self):
        (self.root / "clips.csv").write_text(
            "file,class,actor\na.amc,squat,x\nb.amc,jump,x\nmissed.amc,squat,x\n")
        (self.root / "truth.csv").write_text(
            "file,class,first_frame,last_frame\ntake.amc,squat,101,200\ntake.amc,jump,301,400\n")
        (self.root / "searched.txt").write_text(
            "x/a.amc\nx/b.amc\nx/missed.amc\nx/take.amc\nx/unlabelled.amc\n")
        places = [("a", 1, 90), ("take", 110, 190), ("take", 150, 210), ("take", 310, 390),
                  ("take", 220, 280), ("b", 1, 50), ("unlabelled", 1, 50)]
        (self.root / "hits.json").write_text(json.dumps({
            "scanned_frames": 1000, "elapsed_s": 0.5,
            "hits": [{"file": f"x/{file}.amc", "first_frame": first, "last_frame": last,
                      "start_s": 0, "end_s": 1, "cost": 0.01} for file, first, last in places]}))
        table = self.run_quietly(
            demo_table.main, self.root / "hits.json", self.root / "clips.csv",
            self.root / "truth.csv", "squat", self.root / "searched.txt")
        verdicts = [line.split("–")[-1].split("  ", 1)[1] for line in table.splitlines()[1:8]]
        self.assertEqual(verdicts, ["right", "right", "wrong: the same one again", "wrong: jump",
                                    "wrong: between two motions", "wrong: jump", "not known"])
        self.assertIn("Of 3 × squat, 2 were found and 1 missed; 4 of 7 hits are wrong, 1 lie", table)
        self.assertIn("missed: missed.amc", table)
        self.assertEqual((self.root / "best.txt").read_text(),
                         "x/a.amc:1-90\nx/take.amc:110-190\n")


if __name__ == "__main__":
    unittest.main()
