"""The JSON schema of case files accepts every case of the tree and marks every error of the tables of bad input.

Exceptions are the errors that no schema can detect, which are named here."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import tomllib
import unittest

TREE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TREE / "tests" / "app"))

import test_bad_input  # noqa: E402  (rows, and the case that they change)

try:
    import jsonschema
except ImportError:
    jsonschema = None

# Errors whose detection needs arithmetic with two values of the file, the value of an expression, a name in another
# table, a file, PETSc or the shapes of the case. A schema checks single values and the presence of keys.
UNSEEN = {
    "two values": {
        "box_inside_out", "damping_inside_out", "gate_that_slants", "gate_with_the_wrong_sides", "gate_without_an_extent",
        "level_of_a_fill_where_gravity_is_sideways", "liquid_beside_another_density", "liquid_that_thins_upwards",
        "mooring_without_a_force", "zone_of_oblique_waves_in_a_plane",
        "outlet_without_extent", "period_backwards", "period_empty", "side_walls_without_width",
        "porous_coefficients_without_gravity", "porous_inside_out", "probe_stretch_is_a_point", "probe_times_backwards",
        "region_upside_down", "wave_that_breaks_at_once", "less_than_a_vacuum", "vent_where_air_is_nothing", "fluid inside out",
        "wall without length"},
    "expressions": {
        "displacement_of_a_position", "gravity_of_itself", "infinite_expression", "inlet_discharge_of_position",
        "level_of_the_discharge_or_of_a_parameter",
        "parameter_is_reported_once", "parameter_of_itself", "parameter_of_unknown", "parameter_of_unknown_is_told_all_names",
        "parameter_that_waits_for_a_circle", "spacing_and_parameter_of_each_other", "range_of_an_expression",
        "rotation_of_an_unknown_function", "spacing_of_itself", "unknown_name",
        "unknown_name_is_reported_once_if_dx_uses_it", "velocity_of_an_unknown_name", "velocity_of_z_in_a_plane",
        "gravity_that_changes",
        "unknown parameter", "discharge that jumps", "discharge without a value", "velocity that overflows"},
    "names": {
        "body_of_no_wall", "zone_around_no_wall", "body_with_a_motion", "body_with_the_water_inside", "default_name_taken", "fluid_name_twice",
        "gate_with_the_name_of_a_wall", "liquid_in_a_porous_layer", "liquid_that_is_unknown",
        "liquid_that_no_block_is_of", "two_liquids", "liquids_of_too_different_densities",
        "probe_of_an_unknown_liquid", "inlet_with_water_from_an_unknown_outlet", "mooring_of_no_body",
        "probe_name_twice", "wall_of_two_bodies", "duplicate names of walls and fluids", "duplicate names of probes"},
    "files": {"hydrograph that is not there", "measurement_in_no_file", "measurement_in_a_device", "measurement_in_a_file_that_is_not_there"},
    "no number is equal to it": {"not_a_number", "not a number"},
    "PETSc": {
        "unknown option of PETSc", "option that opens a file", "option that names a file", "option of the whole program",
        "option that ends a solve early", "solver that does not exist"},
    "shapes": {
        "probe outside", "wall probe off the wall", "fluid thinner than a particle", "open wall", "low wall",
        "fluid behind a wall", "fluid on both sides of a wall", "overlap", "too near to a wall",
        "wall that crosses itself", "crest higher than the channel", "gate through the floor",
        "gate table through a roof", "wave maker too low", "gate that closes on the water",
        "lid that crushes the water", "outlet in a wall", "outlet in the water", "outlet above the bed",
        "inlet in a wall", "inlet that faces outwards", "litres for cubic metres", "millimetres per second",
        "level that is a depth", "section that is a point", "vent in a wall", "vent outside of the walls",
        "pressure of open air"},
    "amounts": {
        "spacing that needs more memory than there is", "end time that no run reaches", "spacing beyond the shapes",
        "endless walls", "probe that would fill the disk", "fields that would fill the disk"},
}


def rows_of_the_reader():
    """{name: text} of tests/case/bad_input_test.cpp, which writes its rows to the folder in TAILWATER_BAD_INPUT."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([os.environ["TEST_CASE"], "--gtest_filter=*BadInputTest*"], check=True, capture_output=True,
                       env=os.environ | {"TAILWATER_BAD_INPUT": folder})
        return {path.stem: path.read_text(encoding="utf-8") for path in pathlib.Path(folder).iterdir()}


def rows_of_the_program():
    small = test_bad_input.SMALL_CASE
    return {row.name: small.replace(*row.replace, 1) for row in test_bad_input.TABLE if not row.arguments}


@unittest.skipUnless(jsonschema, "python3-jsonschema is not there (scripts/install.sh tests)")
class Schema(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        words = [os.environ["TAILWATER"], "run", "--help-case=schema"]
        schema = json.loads(subprocess.run(words, capture_output=True, check=True).stdout)
        jsonschema.Draft7Validator.check_schema(schema)
        cls.validator = jsonschema.Draft7Validator(schema)

    def mistakes(self, text):
        """Places and messages of all errors; a text that is not TOML is an error before validation."""
        try:
            case = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            return [str(error)]
        return [f"{error.json_path}: {error.message}" for error in self.validator.iter_errors(case)]

    def test_accepts_every_case_of_the_tree(self):
        cases = [path for folder in ("cases", "src/app/templates", "benchmarks") for path in (TREE / folder).rglob("*.toml")]
        self.assertGreater(len(cases), 40)
        for path in cases:
            self.assertEqual(self.mistakes(path.read_text(encoding="utf-8")), [], path)

    def test_accepts_the_case_that_a_run_leaves(self):
        with tempfile.TemporaryDirectory() as folder:
            for template in ("channel", "wave-flume", "floating-box"):
                for words in (("new", template, "my.toml", "--force"),
                              ("run", "my.toml", "--out", template, "--quiet", "--set", "time.end=1e-3")):
                    subprocess.run([os.environ["TAILWATER"], *words], cwd=folder, check=True, capture_output=True)
                left = pathlib.Path(folder) / template / "case.effective.toml"
                self.assertEqual(self.mistakes(left.read_text(encoding="utf-8")), [], template)

    def test_marks_every_mistake_that_a_schema_can_see(self):
        rows = rows_of_the_reader() | rows_of_the_program()
        unseen = set().union(*UNSEEN.values())
        self.assertLessEqual(unseen, rows.keys())
        for name, text in rows.items():
            self.assertEqual(bool(self.mistakes(text)), name not in unseen, name)

    def test_marks_the_place_of_a_mistake(self):
        text = test_bad_input.SMALL_CASE.replace("interval", "intervall") + "[scheme]\nname = \"farzin2015\"\n"
        places = " ".join(self.mistakes(text))
        for part in ("$.output: ", "'fields_intervall'", "$.scheme.name: 'farzin2015' is not one of ['farzin2014'"):
            self.assertIn(part, places)

    def test_explains_every_key(self):
        for name, table in self.validator.schema["properties"].items():
            keys = table.get("items", table).get("properties", {})
            for key, rule in keys.items():
                self.assertTrue(rule.get("description"), f"{name}.{key}")


if __name__ == "__main__":
    unittest.main()
