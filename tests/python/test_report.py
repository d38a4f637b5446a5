"""Reports: the answer and its interval, the faults that the first line must state, and runs that are made again."""

import contextlib
import html.parser
import io
import json
import re
import shutil
import unittest
from pathlib import Path

import tailwater as tw
from small import DAM, PackageTest
from tailwater import case_features, report_command, report_faults
from tailwater.evidence import load_evidence
from tailwater.report import references_of
from tailwater.report_check import check_files, check_report, read_report

ROOT = Path(__file__).resolve().parents[2]
SOURCES = ROOT / "src"
EFFECTIVE = DAM.replace("spacing = 0.1", "spacing = {spacing}\njitter = 0.0\nseed = 1").replace(
    'name = "tank"', 'name = "tank"\nshape = "polyline"').replace(
    'name = "column"', 'name = "column"\nshape = "box"').replace('"H"', '0.5').replace(
    "[time]", '[scheme]\nintegrator = "explicit"\ncourant = 0.55\n[time]').replace("[case]", "[case]\ndimension = 2")


def amount(volume):
    return {"particles": round(100 * volume), "volume_m3": volume, "mass_kg": 1000 * volume}


def summary(spacing=0.1, value=0.49, **changes):
    """Summary of a made-up run without a fault."""
    return {"status": "done", "commit": "abc", "version": "1.0.0", "warnings": [],
            "time_s": {"end": 0.1, "reached": 0.1}, "particles": {"fluid": 50}, "steps": {"count": 6, "dt_mean_s": 0.01},
            "cost": {"cpu_s": 1.0}, "ranks": {"count": 1},
            "water_balance": {"start": amount(0.5), "in": amount(0.0), "inside": amount(0.5), "outside": amount(0.0),
                              "out": amount(0.0), "inlets": [], "outlets": []},
            "volume": {"outside_the_walls_most": 0, "density_error_mean": 0.0, "density_error_rms": 0.001},
            "energy": {"start_J": 100.0, "largest_rise_J": 0.0, "largest_rise_over_start": 0.0},
            "results": {"depth": {"type": "depth", "words": "", "quantities": [
                {"name": "depth", "value": value - spacing / 10, "unit": "m", "what": "mean"}]}}} | changes


def make_run(path, told, spacing=0.1):
    Path(path).mkdir(parents=True)
    Path(path, "case.effective.toml").write_text(EFFECTIVE.format(spacing=spacing), encoding="utf-8")
    Path(path, "summary.json").write_text(json.dumps(told), encoding="utf-8")


def make_study(path, told=(), spacings=(0.1, 0.125, 0.16)):
    """`told`: {spacing: changes to the summary of its run}."""
    names = [f"spacings/particles.spacing={spacing}" for spacing in spacings]
    for name, spacing in zip(names, spacings):
        make_run(Path(path, name), summary(spacing, **dict(told).get(spacing, {})), spacing)
    study = {"runs": names, "starts": [], "step": None}
    Path(path, "study.json").write_text(json.dumps(study), encoding="utf-8")


class FirstText(html.parser.HTMLParser):
    """Texts of a page in their order, tags that load something, and tags that are not closed."""

    def __init__(self, page):
        super().__init__()
        self.shown, self.loads, self.open = [], [], []
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        self.loads += [value for name, value in attributes if name in ("src", "href") and not value.startswith("data:")]
        if tag not in ("meta", "img", "br"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, tag

    def handle_data(self, data):
        if self.open and self.open[-1] not in ("style", "script", "title") and data.strip():
            self.shown.append(data.strip())


class MadeUp(PackageTest):
    def first_line(self, **changes):
        """First line for a study whose middle run has these changes in its summary."""
        make_study("s", {0.125: changes})
        return tw.report("s", pictures=0).first_line

    def test_answer_with_its_interval_comes_first(self):
        make_study("s")
        made = tw.report("s", answer="depth, depth", question="How deep?", pictures=0)
        row = made.content["answer"]
        self.assertTrue(made.is_reliable, made.content["faults"])
        self.assertEqual(made.first_line.split("?")[0], "How deep")
        self.assertIn(f"{row['limit']:.5g} m, 95 % interval {row['low']:.5g} to {row['high']:.5g} m", made.first_line)
        page = FirstText(made.html())
        self.assertEqual([page.shown[0], page.loads, page.open], [made.first_line, [], []])
        made.write("out.html")
        told = json.loads(Path("out.json").read_text(encoding="utf-8"))
        self.assertEqual(told, made.content)
        self.assertEqual(read_report("out.html")["runs"], told["runs"])
        for part in ("explain", "drawing"):
            self.assertTrue(told["case"][part], part)

    def test_one_spacing_cannot_be_relied_on(self):
        make_run("run", summary())
        made = tw.report("run", pictures=0)
        self.assertFalse(made.is_reliable)
        self.assertRegex(made.first_line, "^This number cannot be relied on: one spacing only.* depth, depth: 0.48 m")
        make_study("s", spacings=(0.1,))
        self.assertIn("fewer than 3 finished spacings", tw.report("s", pictures=0).first_line)

    def test_leak(self):
        lost = summary()["water_balance"] | {"inside": amount(0.49), "outside": amount(0.01)}
        self.assertRegex(self.first_line(water_balance=lost), r"^This number cannot be relied on: water leaks \(2 % left")

    def test_balance_that_does_not_close(self):
        lost = summary()["water_balance"] | {"inside": amount(0.49)}
        self.assertIn("relied on: the water balance does not close (2 %", self.first_line(water_balance=lost))

    def test_level_that_is_not_held(self):
        outlet = {"name": "sea", "level_missed": {"by_m": -0.03, "since_s": 0.1, "for_s": 2.0}}
        self.assertIn("relied on: a level is not held ('sea', off by 0.03 m for 2 s) at the spacing 0.125 m",
                      self.first_line(water_balance=summary()["water_balance"] | {"outlets": [outlet]}))

    def test_energy_that_rose(self):
        line = self.first_line(warnings=["at t = 1 s the energy rose, without the work of walls, by 1 %"],
                               energy={"start_J": 100.0, "largest_rise_J": 2.0, "largest_rise_over_start": 0.02})
        self.assertIn("relied on: the energy rose (by 2 J, 2 % of the start)", line)

    def test_answer_that_still_changes(self):
        results = summary()["results"]
        results["depth"]["quantities"][0]["what"] = "mean of the second half, still rising"
        self.assertIn("relied on: the answer is not steady (mean of the second half, still rising)",
                      self.first_line(results=results))

    def test_largest_value_of_the_start(self):
        def line(time, mean, dt=0.01):
            results = summary()["results"]
            results["depth"]["quantities"] = [
                {"name": "depth", "value": 0.6, "unit": "m", "what": f"at {time} s"},
                {"name": "mean depth", "value": mean, "unit": "m", "what": "mean of the second half"}]
            shutil.rmtree("s", ignore_errors=True)
            return self.first_line(results=results, steps={"count": 6, "dt_mean_s": dt})

        told = "the answer is a value of the start, when all water is released at once (at 0.02 s)"
        self.assertIn(told, line(0.02, 0.3))
        self.assertNotIn("value of the start", line(0.02, 0.59))
        self.assertNotIn("value of the start", line(0.02, 0.3, dt=0.001))

    def test_probe_that_is_read_too_seldom(self):
        results = summary()["results"]
        results["depth"]["quantities"][0]["what"] = "mean of the second half"
        make_study("s", {0.125: {"results": results, "steps": {"count": 100, "dt_mean_s": 0.001}}})
        table = Path("s/spacings/particles.spacing=0.125/probes/depth.csv")
        table.parent.mkdir()
        table.write_text("time_s,connected_m\n0,0.5\n0.04,0.5\n0.08,0.5\n", encoding="utf-8")
        self.assertIn("relied on: the answer has too few readings (1 of the probe 'depth' in the second half of the run) at the "
                      "spacing 0.125 m", tw.report("s", pictures=0).first_line)
        lines = [f"{0.001 * k:.9g},0.5\n" for k in range(101)]
        table.write_text("time_s,connected_m\n" + "".join(lines), encoding="utf-8")
        self.assertTrue(tw.report("s", pictures=0).is_reliable)

    def test_probe_that_is_read_once(self):
        """The value of the last reading counts, unless it is that of the start."""
        results = summary()["results"]
        for time, is_reliable in ((0.05, True), (0.0, False)):
            results["depth"]["quantities"][0]["what"] = f"at {time:.4g} s"
            make_study(f"s{time}", {0.125: {"results": results, "steps": {"count": 100, "dt_mean_s": 0.001}}})
            table = Path(f"s{time}/spacings/particles.spacing=0.125/probes/depth.csv")
            table.parent.mkdir()
            table.write_text(f"time_s,connected_m\n{time},0.5\n", encoding="utf-8")
            self.assertEqual(tw.report(f"s{time}", pictures=0).is_reliable, is_reliable)

    def test_probe_without_a_result(self):
        make_study("s", {spacing: {"results": {}} for spacing in (0.1, 0.125, 0.16)})
        for answer in ("", "depth"):
            made = tw.report("s", answer=answer, pictures=0)
            self.assertEqual(made.first_line, "This number cannot be relied on: the answer has no result (too few readings of the "
                             "probe 'depth', or none) at the spacing 0.1, 0.125, 0.16 m. no result.")
        self.assertIn("depth: no result, because the runs had too few readings, or none", tw.Study.load("s").text())

    def test_probe_without_a_result_in_one_run(self):
        line = self.first_line(results={})
        self.assertIn("has no result (too few readings of the probe 'depth', or none) at the spacing 0.125 m", line)
        self.assertIn("depth, depth: no result, because a run had too few readings, or none", tw.Study.load("s").text())

    def test_unfinished_run(self):
        line = self.first_line(status="interrupted", time_s={"end": 0.1, "reached": 0.04})
        self.assertRegex(line, "^This number cannot be relied on: the study is unfinished")
        self.assertIn("a run is unfinished (interrupted at t = 0.04 of 0.1 s)", line)

    def test_study_that_was_killed(self):
        make_study("s")
        Path("s/study.json").unlink()
        made = tw.report("s", pictures=0)
        self.assertIn("relied on: the study is unfinished", made.first_line)
        self.assertEqual(len(made.content["runs"]), 3)

    def test_runs_of_several_programs(self):
        self.assertIn("programs of different commits", self.first_line(commit="def"))

    def test_runs_of_several_cases(self):
        make_study("s")
        case = Path("s/spacings/particles.spacing=0.125/case.effective.toml")
        text = case.read_text(encoding="utf-8")
        case.write_text(text.replace("end = 0.1", "end = 0.2"), encoding="utf-8")
        self.assertIn("relied on: its runs are of different cases (time.end = 0.1 and 0.2).",
                      tw.report("s", pictures=0).first_line)
        case.write_text(text.replace('name = "depth"', 'name = "level"'), encoding="utf-8")
        self.assertIn("(probe.depth.name = depth and nothing, ", tw.report("s", pictures=0).first_line)

    def test_keys_that_follow_the_spacing(self):
        make_study("s")
        for spacing in (0.1, 0.125, 0.16):
            case = Path(f"s/spacings/particles.spacing={spacing}/case.effective.toml")
            text = case.read_text(encoding="utf-8").replace("at = [0.5, 0]", f"at = [{1 - 4 * spacing:.9g}, 0]")
            case.write_text(text, encoding="utf-8")
        self.assertTrue(tw.report("s", pictures=0).is_reliable)

    def test_other_warnings_are_listed_only(self):
        make_study("s", {0.125: {"warnings": ["something else"]}})
        made = tw.report("s", pictures=0)
        self.assertTrue(made.is_reliable)
        self.assertEqual(made.content["warnings"], [{"message": "something else", "spacings_m": [0.125]}])

    def test_wrong_names_are_refused(self):
        with self.assertRaisesRegex(tw.DataError, "nowhere: has no run and no study; remedy: "):
            tw.report("nowhere")
        make_run("run", summary())
        with self.assertRaisesRegex(tw.DataError, '"height" is no result; there are: depth, depth'):
            tw.report("run", answer="height", pictures=0)


class Real(PackageTest):
    def setUp(self):
        super().setUp()
        Path("data").mkdir()
        Path("data/gauge.csv").write_text("# made up\ntime_s,connected_m\n0,0.5\n0.02,0.49\n", encoding="utf-8")
        measured = '[[measurement]]\nprobe = "depth"\ncolumn = "connected"\nfile = "data/gauge.csv"\n'
        self.case = tw.Case(self.write("dam.toml", DAM + measured)).update({"time.end": 0.02, "scheme.courant": 0.05})

    def test_study_is_reproduced_from_the_page_alone(self):
        tw.study(self.case, out="s", spacings=[0.1, 0.125, 0.16], starts=1)
        guide = (ROOT / "docs/guide/report.md").read_text(encoding="utf-8")
        script = re.search(r"```python\n(.*?)```", guide, re.DOTALL)[1]
        told = io.StringIO()
        with contextlib.redirect_stdout(told):
            exec(script.replace("my_weir_study", "s").replace("upstream", "depth"), {})
        self.assertRegex(told.getvalue(), "^True .* 95 % interval")
        self.assertTrue(Path("dossier.html").is_file())
        made = tw.report("s")
        self.assertTrue(made.is_reliable, made.first_line)
        roles = [run["role"] for run in made.content["runs"]]
        self.assertEqual(roles, ["spacing"] * 3 + ["start", "half step"])
        self.assertEqual([Path(one["path"]).name for one in made.content["inputs"]], ["gauge.csv"])
        self.assertTrue(all("png" in picture for picture in made.content["pictures"]), made.content["pictures"])
        made.write("report.html")
        shutil.rmtree("s")
        shutil.rmtree("data")
        told = []
        self.assertTrue(check_report(read_report("report.html"), told.append))
        self.assertEqual([line.endswith("the same, bit for bit") for line in told[:5]], [True] * 5)
        self.assertEqual(told[5:], ["answer: the same, computed again from these runs"])
        content = read_report("report.json")
        content["runs"][1]["outputs"]["probes/depth.csv"] = "0"
        told.clear()
        self.assertFalse(check_report(content, told.append))
        self.assertEqual([line for line in told if "differs" in line], ["spacing at 0.125 m: differs in probes/depth.csv"])
        content["inputs"][0]["sha256"] = "0"
        with self.assertRaisesRegex(tw.DataError, "gauge.csv: is missing or is not the file of the report; remedy"):
            check_report(content, told.append)

    def test_answer_is_computed_again(self):
        tw.study(self.case, out="s", spacings=[0.1, 0.125, 0.16], starts=0, step=False)
        tw.report("s", pictures=0).write("page.html")
        made = read_report("page.json")
        row, told = made["answer"], []

        def forged(**changes):
            told.clear()
            self.assertFalse(check_report(made | changes, told.append))
            return told[-1]

        more = row | {"limit": 99.0}
        self.assertRegex(forged(answer=more), "^answer: depth, depth: the limit is 99 in the report and 0.4.* by the runs; ")
        self.assertIn("the high is ", forged(results=[row | {"high": 1.001 * row["high"]}, *made["results"][1:]]))
        self.assertIn("the first line is not that of the answer", forged(first_line="All is well."))
        self.assertIn("the runs do not have the fault: rain", forged(faults=["rain"]))
        runs = [made["runs"][0] | {"value": 1.0}, *made["runs"][1:]]
        self.assertIn("the record of the spacing at 0.1 m differs in value", forged(runs=runs))

    def test_pages_are_compared(self):
        self.case.run("run")
        tw.report("run", pictures=1).write("page.html")
        told = []
        self.assertTrue(check_files("page.html", told.append), told)
        self.assertTrue(check_files("page.json", told.append), told)
        page = Path("page.html").read_text(encoding="utf-8")
        head, mark, data = page.partition('<script type="application/json" id="report">')
        number = re.search(r"depth, depth: ([0-9.]+) m", head)[1]
        Path("page.html").write_text(head.replace(number, "9.9") + mark + data, encoding="utf-8")
        for file in ("page.html", "page.json"):
            told.clear()
            self.assertFalse(check_files(file, told.append))
            self.assertEqual(told, ["page.html: does not show the numbers that it holds"])
        Path("page.html").write_text(page.replace(number, "9.9"), encoding="utf-8")
        told.clear()
        self.assertFalse(check_files("page.html", told.append))
        self.assertIn("page.json: is not of the same content as page.html", told)

    def test_input_file_that_is_gone(self):
        self.case.run("run")
        Path("data/gauge.csv").unlink()
        made = tw.report("run", pictures=0)
        self.assertEqual(made.content["inputs"][0]["sha256"], "")
        self.assertRegex(made.first_line, "^This number cannot be relied on: .*the input file /.*/data/gauge.csv is gone")
        with self.assertRaisesRegex(tw.DataError, "gauge.csv: is missing.*gone when the report was written"):
            check_report(made.content, list().append)

    def test_input_file_that_has_changed(self):
        Path("data/move.csv").write_text("t [s],x [m]\n0,0\n1,0\n", encoding="utf-8")
        self.case["wall.tank.motion"] = "data/move.csv"
        self.case.run("run")
        self.assertNotIn("has changed", tw.report("run", pictures=0).first_line)
        Path("data/move.csv").write_text("t [s],x [m]\n0,0\n1,0.1\n", encoding="utf-8")
        self.assertRegex(tw.report("run", pictures=0).first_line, "relied on: .*the input file /.*/move.csv has changed since")

    def test_command(self):
        self.case.run("run")
        self.assertEqual(report_command.main(["run", "--answer", "depth", "--pictures", "0", "--to", "page.html"]), 0)
        self.assertEqual(report_command.main(["page.json", "--check"]), 0)
        self.assertEqual(report_command.main(["dam.toml", "--check"]), 2)
        self.assertEqual(report_command.main(["none.json", "--check"]), 4)
        content = read_report("page.json")
        content["runs"][0]["outputs"]["steps.csv"] = "0"
        Path("page.json").write_text(json.dumps(content), encoding="utf-8")
        self.assertEqual(report_command.main(["page.json", "--check"]), 1)


class References(unittest.TestCase):
    def test_datum_and_coordinate_system_are_named(self):
        sentences = references_of({"case": {"datum": "DHHN2016", "crs": "EPSG:25832"}})
        self.assertEqual(sentences, ["Vertical datum: DHHN2016.", "Coordinate reference system: EPSG:25832."])

    def test_missing_ones_are_reported(self):
        self.assertTrue(all("names no" in sentence for sentence in references_of({"case": {}})))


class Features(unittest.TestCase):
    def test_features_of_a_template(self):
        weir = tw.Case.template("weir")
        self.assertEqual(case_features.features_of(weir._data), {"2D", "inlet", "outlet", "plate"})

    def test_limits_go_with_features(self):
        def words(*features):
            return " ".join(one["text"] for one in case_features.limits_of(features))

        self.assertIn("sustain no tension", words())
        self.assertIn("Air is not simulated", words("2D"))
        self.assertNotIn("Air is not simulated", words("air pockets"))
        self.assertNotIn("waves lose height", words("inlet"))
        self.assertIn("waves lose height", words("wave maker"))

    def test_pages_of_limits_are_there(self):
        for one in case_features.limits_of({feature for _, _, needed in case_features.LIMITS for feature in needed}):
            page, _, place = one["page"].partition("#")
            text = (SOURCES.parent / page).read_text(encoding="utf-8")
            if place:
                self.assertIn(f"## {place}", text.lower())

    def test_nearest_flow(self):
        flows = [{"name": "weir", "features": ["2D", "inlet", "outlet"], "kinds": ["discharge"]},
                 {"name": "gate", "features": ["2D", "inlet", "outlet"], "kinds": ["level"]},
                 {"name": "dam", "features": ["2D", "released water"], "kinds": ["level"]}]
        self.assertEqual(case_features.nearest_flow({"2D", "released water"}, flows)["name"], "dam")
        self.assertEqual(case_features.nearest_flow({"2D", "inlet", "outlet"}, flows, "level")["name"], "gate")
        found = case_features.nearest_flow({"2D", "inlet", "plate"}, flows, "discharge")
        self.assertEqual([found["name"], found["shared"], found["only_here"], found["only_there"]],
                         ["weir", ["2D", "inlet"], ["plate"], ["outlet"]])


    def test_nearest_flows_of_templates(self):
        flows = load_evidence()["flows"]
        for template, expected in (("weir", "weir"), ("floating-box", "floating-box"), ("solitary-wave", "solitary-wave"),
                                   ("pier", "kleefsman2005")):
            features = case_features.features_of(tw.Case.template(template)._data)
            self.assertEqual(case_features.nearest_flow(features, flows)["name"], expected)


class Messages(unittest.TestCase):
    def test_program_still_writes_them(self):
        """Faults are recognised by the words of warnings."""
        sources = " ".join(path.read_text(encoding="utf-8") for folder in ("results", "open_ends")
                           for path in (SOURCES / folder).glob("*.cpp"))
        sources = re.sub(r'"\s*\n\s*"', "", sources)
        for kind, words in report_faults.MESSAGES.items():
            self.assertRegex(sources, words, kind)
        checks = (SOURCES / "checks/probes.cpp").read_text(encoding="utf-8")
        self.assertIn("{}: interval = {:.6g} gives {:.0f} {}", checks)


if __name__ == "__main__":
    unittest.main()
