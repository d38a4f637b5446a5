"""The stream that a run writes for viewers: view/scene.json and frames."""

import json
import math
import pathlib
import tomllib
import unittest

from frames import read_frames
from program import PATIENCE, ProgramTest

CASES = pathlib.Path(__file__).resolve().parents[2] / "cases"


class Stream(ProgramTest):
    def test_of_a_dam_break_is_small(self):
        """The demo's case, coarser. Far fewer bytes than places and scalars take as they are: 6 per particle."""
        case = CASES / "zhou1999" / "case.toml"
        self.call("run", case, "--out", "run", "--quiet", "--set", "particles.spacing=0.025")
        frames = read_frames(self.folder / "run")
        # A four-hundredth of the end time apart, and eight steps.
        end = tomllib.loads((self.folder / "run/case.effective.toml").read_text())["time"]["end"]
        steps = [time for time, *_ in self.table("run/steps.csv")[1]]
        interval, expected, next_step = end / 400, [0.0], 8
        for step, time in enumerate(steps, 1):
            if step >= next_step and time >= (math.floor(expected[-1] / interval) + 1) * interval:
                expected.append(time)
                next_step = step + 8
        self.assertEqual([frame.time for frame in frames], sorted({*expected, steps[-1]}))
        self.assertGreater(len(frames), 50)
        self.assertLessEqual(sum(frame.bytes for frame in frames) / sum(frame.count for frame in frames), 3.0)
        keys = [frame.index for frame in frames if frame.order == 0] + [len(frames)]
        self.assertEqual(keys[0], 0)
        self.assertLessEqual(max(b - a for a, b in zip(keys, keys[1:])), 10)
        reached = self.summary("run")["time_s"]["reached"]
        self.assertEqual(frames[-1].time, reached)

    def test_has_walls_probes_and_all_water(self):
        self.call("run", "small.toml", "--out", "run", "--quiet")
        scene = json.loads((self.folder / "run/view/scene.json").read_text())
        self.assertEqual(scene["title"], "Small dam break")
        self.assertEqual([wall["name"] for wall in scene["walls"]], ["tank"])
        self.assertEqual([probe["file"] for probe in scene["probes"]],
                         ["probes/depth.csv", "probes/wall_pressure.csv", "probes/energy.csv"])
        self.assertTrue(all(frame.count == 50 for frame in read_frames(self.folder / "run")))

    def test_interval(self):
        self.call("run", "small.toml", "--out", "run", "--quiet", "--set", "output.view_interval=0.05")
        times = [frame.time for frame in read_frames(self.folder / "run")]
        self.assertEqual(len(times), 3)
        self.assertEqual(times[0], 0.0)
        self.assertGreaterEqual(times[1], 0.05)
        result = self.call("run", "small.toml", "--out", "many", "--set", "output.view_interval=1e-9", expect=2)
        self.assertIn("output.view_interval = 1e-09: makes 1e+08 frames", result.stderr)

    def test_poses_of_what_moves(self):
        gate = ('wall=[{points=[[0, 2], [0, 0], [3, 0], [3, 2]]}, '
                '{name="gate", points=[[1, 0], [1, 2]], displacement=["0", "1.5*t"]}]')
        self.call("run", "small.toml", "--out", "run", "--quiet", "--set", gate)
        scene = json.loads((self.folder / "run/view/scene.json").read_text())
        self.assertEqual([wall["moving"] for wall in scene["walls"]], [None, 0])
        for frame in read_frames(self.folder / "run"):
            (x, y, angle), = frame.poses
            self.assertEqual((x, angle), (0.0, 0.0))
            self.assertAlmostEqual(y, 1.5 * frame.time, places=12)

    def test_a_run_goes_on_without_its_folder(self):
        process = self.start("run", "small.toml", "--out", "run", "--quiet", "--set", "time.end=1000", "--set",
                             "output.view_interval=0.01")
        view = self.folder / "run/view"
        self.wait_for((view / "00002.frame").exists, process)
        view.rename(self.folder / "gone")  # at once: files that come meanwhile would keep it
        last = lambda: max((int(path.stem) for path in view.glob("*.frame")), default=0)
        self.wait_for(lambda: last() > 5, process)
        (self.folder / "run/STOP").touch()
        self.assertEqual(process.wait(timeout=PATIENCE), 130)
        self.call("resume", "run", "--quiet", "--set", f"time.end={self.summary('run')['time_s']['reached'] + 0.05}")

    def test_of_an_earlier_run_is_removed(self):
        self.call("run", "small.toml", "--out", "run", "--quiet")
        (self.folder / "run/view/notes.txt").write_text("mine")
        self.call("run", "small.toml", "--out", "run", "--force", "--quiet", "--set", "output.view_interval=1")
        self.assertEqual(len(read_frames(self.folder / "run")), 2)
        self.assertEqual((self.folder / "run/view/notes.txt").read_text(), "mine")


if __name__ == "__main__":
    unittest.main()
