"""The published points and the scores of a made-up run of cases/ozmen_cagatay2014."""

import tomllib
import unittest

import numpy as np

import synthetic_run
from tailwater.run import Run
from tailwater_validation.studies import ozmen_cagatay2014

CASE = synthetic_run.CASES / "ozmen_cagatay2014" / "case.toml"
H0, GATE, SCALE = ozmen_cagatay2014.DEPTH, ozmen_cagatay2014.GATE, ozmen_cagatay2014.TIME_SCALE
END = 56.0  # T

EFFECTIVE_CASE = """\
[case]
dimension = 2
title = "A made-up bore"
[physics]
density = 1000.0
[particles]
spacing = 0.025
[scheme]
name = "{scheme}"
integrator = "explicit"
[[wall]]
name = "channel"
shape = "polyline"
points = [[0.0, 0.5], [0.0, 0.0], [6.15, 0.0], [6.65, 0.075], [7.15, 0.0], [8.9, 0.0]]
"""


def write_run(folder, factor=1.0, delay=0.0, scheme="farzin2014"):
    """Each profile is level at `factor` times the measured height; each gauge rises at T = its point's plus `delay` through
    the measured height, at 0.01 h0 per T."""
    folder = synthetic_run.make_folder(folder, EFFECTIVE_CASE.format(scheme=scheme)
                                       + synthetic_run.measurements("ozmen_cagatay2014"))
    run = Run(folder)
    x = np.arange(0.0125, 8.9, 0.025)
    bed = H0 * ozmen_cagatay2014.bed((x - GATE) / H0)
    rows = []
    for point in ozmen_cagatay2014.read_points(run, "profile"):
        depth = np.maximum(0, factor * point.measured * H0 - bed)
        rows.append(np.stack([np.full_like(x, point.T * SCALE), x, bed, depth, depth]))
    synthetic_run.write_surfaces(folder, rows)
    T = np.arange(0, END, 0.5)
    for point in ozmen_cagatay2014.read_points(run, "gauge"):
        level = factor * (point.measured + 0.01 * (T - point.T - delay))
        depth = H0 * (level - ozmen_cagatay2014.bed(point.X))
        synthetic_run.write_probe(folder, point.gauge, {"time_s": T * SCALE, "connected_m": depth, "highest_m": depth})
    return folder


class Data(synthetic_run.CaseTest):
    def test_every_file_says_where_it_comes_from(self):
        for path in (CASE.parent / "data").iterdir():
            for word in ("# WHAT:", "# PAPER:", "# CAVEAT:"):
                self.assertIn(word, path.read_text(), path)

    def test_the_case_is_the_one_that_is_scored(self):
        with open(CASE, "rb") as file:
            case = tomllib.load(file)
        self.assertEqual((case["parameters"]["h0"], case["parameters"]["reservoir"]), (H0, GATE))
        self.assertEqual(case["parameters"]["crest"], ozmen_cagatay2014.HUMP_HEIGHT * H0)
        self.assertEqual(case["parameters"]["hump"], (ozmen_cagatay2014.HUMP_END - ozmen_cagatay2014.TOE) * H0)
        probes = {probe["name"]: probe for probe in case["probe"]}
        run = Run(write_run(self.folder))
        self.assertEqual([float(time.removesuffix("*sqrt(h0/g)")) for time in probes["surface"]["times"]],
                         sorted(point.T for kind in ("profile", "gauge") for point in ozmen_cagatay2014.read_points(run, kind)))
        for point in ozmen_cagatay2014.read_points(run, "gauge"):
            self.assertEqual(probes[point.gauge]["at"][0], f"reservoir{point.X:+g}*h0")


class Scores(synthetic_run.CaseTest):
    def score(self, **options):
        write_run(self.folder, **options)
        return {metric.name: metric for metric in ozmen_cagatay2014.metrics(Run(self.folder))}

    def test_heights_that_are_wrong_by_a_known_share(self):
        metrics = self.score(factor=1.05)
        for kind in ("profile", "gauge"):
            self.assertAlmostEqual(metrics[f"mean error {kind}"].value, 5, places=9)
            self.assertAlmostEqual(metrics[f"largest error {kind}"].value, 5, places=9)
            self.assertEqual(metrics[f"mean error {kind}"].verdict, "met")
            # The other reading differs where a point is over the hump.
            self.assertGreater(metrics[f"mean error {kind} depth"].value, 8)

    def test_bars_are_the_schemes_own(self):
        for scheme, verdict in (("farzin2014", "missed"), ("farmani2020", "met")):
            metrics = self.score(factor=1.09, scheme=scheme)
            for kind in ("profile", "gauge"):
                self.assertEqual(metrics[f"mean error {kind}"].verdict, verdict)
            self.folder = self.folder.with_name("other")

    def test_a_bore_that_is_late(self):
        metrics = self.score(delay=0.7)
        for gauge in ozmen_cagatay2014.ON_THE_BORE:
            self.assertAlmostEqual(metrics[f"bore {gauge}"].value, 0.7, places=9)

    def test_drawn(self):
        write_run(self.folder)
        self.assert_drawn(ozmen_cagatay2014)


if __name__ == "__main__":
    unittest.main()
