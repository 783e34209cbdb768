"""Opens the NetCDF and NPY files of sweeps as their users do, and holds them to the CSV of the same sweep.

usage: arrays_test.py RICOCHET WORK_DIRECTORY
"""
import csv
import os
import pathlib
import subprocess
import unittest
from unittest import mock

import netCDF4
import numpy
import xarray

from ricochet_case import RICOCHET, RicochetCase, WORK, ricochet

MU, PHI = "friction.kinetic_coefficient", "pendulum.phi_rad"
RATE, WORK_DONE = "rates_after_rad_s[0]", "work.normal_total_j"
# Frictions of which the first is invalid, and angles; 3 x 5 x 7 points.
GRID = ["sweep", "--a", "0.6", "--b", "0.8", "--energetic", "1", "--axis", f"{MU}=-0.1,0.2,0.5", "--axis",
        "restitution.energetic=lin:0:1:5", "--axis", f"{PHI}=lin:0.1:1.5:7", "--column", f"{RATE},{WORK_DONE}"]
ZIP = ["sweep", "--a", "0.6", "--b", "0.8", "--energetic", "1", "--zip", "--axis", f"{MU}=lin:0:1:4", "--axis",
       f"{PHI}=lin:0.1:1.5:4", "--column", RATE]


class ArraysTest(RicochetCase):
    def rows(self, sweep):
        """The lines of the CSV, by column."""
        lines = list(csv.reader(self.made(*sweep, "--format", "csv").splitlines()))
        return {name: [line[i] for line in lines[1:]] for i, name in enumerate(lines[0])}

    def numbers(self, texts):
        return numpy.array([float(text) for text in texts])

    def test_a_grid_is_a_netcdf_file_with_an_axis_a_dimension(self):
        self.made(*GRID, "--regime", "-o", "grid.nc")
        rows = self.rows([*GRID, "--regime"])
        with xarray.open_dataset(WORK / "grid.nc") as data:
            self.assertEqual(dict(data.sizes), {MU: 3, "restitution.energetic": 5, PHI: 7})
            numpy.testing.assert_array_equal(data[PHI].values, self.numbers(rows[PHI][:7]))
            numpy.testing.assert_array_equal(data[MU].values, [-0.1, 0.2, 0.5])
            for column in (RATE, WORK_DONE):
                numpy.testing.assert_array_equal(data[column].values.ravel(), self.numbers(rows[column]))
            self.assertEqual(data[RATE].dims, (MU, "restitution.energetic", PHI))
            self.assertEqual((data[RATE].attrs["units"], data[WORK_DONE].attrs["units"]), ("rad/s", "J"))
            self.assertEqual((data[PHI].attrs["units"], data[MU].attrs["units"]), ("rad", "1"))
            self.assertTrue(data[RATE].attrs["long_name"])
            names = data["regime"].attrs["flag_meanings"].split()
            self.assertEqual([names[i] for i in data["regime"].values.ravel()], rows["regime"])
            names = data["status"].attrs["flag_meanings"].split()
            self.assertEqual(
                [names[i] for i in data["status"].values.ravel()], [text.split(":")[0] for text in rows["status"]])
            # An angle picks the curve over the other axes.
            self.assertFalse(numpy.isnan(data[RATE].sel({PHI: 0.8, MU: 0.2}, method="nearest")).any())

    def test_no_file_gets_what_is_written_to_a_closed_standard_error(self):
        for name in ("rows.csv", "rows.json", "rows.jsonl", "rows.npy", "rows.nc"):
            with self.subTest(name):
                self.made(*GRID, "--regime", "-o", f"open.{name}")
                for closed in ((0,), (1,), (2,), (0, 2), (0, 1, 2)):
                    code = subprocess.run([RICOCHET, *GRID, "--regime", "-o", name], cwd=WORK, check=False,
                                          preexec_fn=lambda: [os.close(number) for number in closed]).returncode
                    self.assertEqual(code, 0)
                    self.assertEqual((WORK / name).read_bytes(), (WORK / f"open.{name}").read_bytes())

    def test_a_closed_stream_cannot_be_used(self):
        for number, arguments, words in ((1, ["scene", "list"], "cannot write the output: Bad file descriptor"),
                                         (0, ["solve", "--scene", "-"], "cannot read standard input")):
            with self.subTest(number):
                done = subprocess.run([RICOCHET, *arguments], stderr=subprocess.PIPE, text=True, check=False,
                                      preexec_fn=lambda: os.close(number))
                self.assertNotEqual(done.returncode, 0)
                self.assertIn(words, done.stderr)

    def test_an_axis_has_the_values_of_numpy(self):
        random = numpy.random.default_rng(1)
        for start, stop, count in [(-0.1, 0.3, 5), *((*random.normal(0, 3, 2), int(random.integers(2, 90))) for _ in range(20))]:
            self.made("sweep", "--a", "0.6", "--b", "0.8", "--energetic", "1", "--axis",
                      f"{PHI}=lin:{float(start)!r}:{float(stop)!r}:{count}", "--column", RATE, "-o", "axis.npy")
            numpy.testing.assert_array_equal(numpy.load(WORK / "axis.npy")[PHI], numpy.linspace(start, stop, count))

    def test_netcdf_says_where_its_numbers_come_from(self):
        self.made(*GRID, "-o", "source.nc")
        version = self.made("--version")
        with netCDF4.Dataset(WORK / "source.nc") as data:
            self.assertEqual(data.Conventions, "CF-1.8")
            self.assertIn(data.ricochet_engine_fingerprint, version)
            self.assertIn(data.source, version)
            self.assertRegex(data.ricochet_grid_fingerprint, "^[0-9a-f]{16}$")
            (WORK / "request.json").write_text(data.ricochet_request)
        again = self.made("sweep", "--request", "request.json", "--format", "csv")
        self.assertEqual(again, self.made(*GRID, "--format", "csv"))

    def test_the_lengths_of_a_broken_netcdf_file_are_not_believed(self):
        with netCDF4.Dataset(WORK / "broken.nc", "w") as data:
            data.ricochet_request = "{}"
            data.createDimension("x", None)
            data.createDimension("y", 2**40)
            data.createVariable("y", "f8", ("y",), chunksizes=(1024,))
            data.createVariable("number", "f8", ("x", "y"), chunksizes=(1, 1024))
        self.assertIn("points", self.refused("plot", "broken.nc", "-o", "broken.svg", code=42))

    def test_a_zip_and_a_part_of_a_grid_are_lists_of_points(self):
        for name, sweep in {"zip.nc": ZIP, "part.nc": [*GRID, "--range", "11:31"]}.items():
            self.made(*sweep, "-o", name)
            rows = self.rows(sweep)
            with xarray.open_dataset(WORK / name) as data:
                self.assertEqual(dict(data.sizes), {"point": len(rows["index"])})
                numpy.testing.assert_array_equal(data["index"].values, [int(text) for text in rows["index"]])
                for path in (MU, PHI, RATE):
                    numpy.testing.assert_array_equal(data[path].values, self.numbers(rows[path]))
                self.assertIn(MU, data.coords)

    def test_npy_has_a_record_a_point(self):
        for format_arguments in (["-o", "grid.npy"], ["--format", "npy", "-o", "grid"]):
            self.made(*GRID, "--regime", *format_arguments)
            records = numpy.load(WORK / format_arguments[-1])
            rows = self.rows([*GRID, "--regime"])
            self.assertEqual(records.dtype.names, ("index", MU, "restitution.energetic", PHI, RATE, WORK_DONE, "regime", "status"))
            self.assertEqual(records["index"].tolist(), list(range(3 * 5 * 7)))
            for path in (MU, PHI, RATE, WORK_DONE):
                numpy.testing.assert_array_equal(records[path], self.numbers(rows[path]))
            self.assertEqual({number for number, name in zip(records["regime"], rows["regime"]) if name == "REBOUND"}, {2})
            self.assertEqual({number for number, name in zip(records["status"], rows["status"]) if name == "OK"}, {1})

    def test_without_axes_there_is_one_point(self):
        sweep = ["sweep", "--a", "0.6", "--b", "0.8", "--mu", "0.1", "--energetic", "1", "--column", RATE]
        self.made(*sweep, "-o", "one.nc")
        self.made(*sweep, "-o", "one.npy")
        with netCDF4.Dataset(WORK / "one.nc") as data:
            self.assertEqual(data[RATE][:].tolist(), numpy.load(WORK / "one.npy")[RATE].tolist())

    def test_shards_merge_to_the_bytes_of_one_run(self):
        for name in ("whole.nc", "whole.npy"):
            self.made(*GRID, "--regime", "-o", name)
            for shard in range(4):
                self.made(*GRID, "--regime", "-o", "parts", "--shard-index", str(shard), "--shard-count", "4")
            merged = "merged" + pathlib.Path(name).suffix
            self.made("merge", "parts", "-o", merged)
            self.assertEqual((WORK / merged).read_bytes(), (WORK / name).read_bytes(), name)

    def test_many_chunks_fill_their_places(self):
        sweep = ["sweep", "--a", "0.6", "--b", "0.8", "--energetic", "1", "--axis", f"{MU}=lin:0:1:11", "--axis",
                 f"{PHI}=lin:0.1:1.5:10007", "--axis", "restitution.energetic=0.5,1", "--column", RATE]
        self.made(*sweep, "-o", "large.nc")
        self.made(*sweep, "-o", "large.npy")
        with netCDF4.Dataset(WORK / "large.nc") as data:
            numpy.testing.assert_array_equal(data[RATE][:].ravel(), numpy.load(WORK / "large.npy")[RATE])

    def test_what_cannot_be_is_refused_in_words(self):
        for arguments, words in {
                ("--format", "netcdf"): "NetCDF needs -o FILE",
                ("-o", "x.nc", "--resume"): "--resume needs -o FILE as csv, json, jsonl or npy",
                ("-o", "x.nc", "--summary-only"): "a summary is no array",
                ("-o", "no/such/directory/x.nc"): "no/such/directory/x.nc"}.items():
            code, _, error = ricochet(*GRID, *arguments)
            self.assertNotEqual(code, 0)
            self.assertIn(words, error)
        self.assertFalse((WORK / "x.nc").exists())

    def test_a_netcdf_library_that_cannot_be_loaded_is_named(self):
        self.made(*GRID, "-o", "read.nc")
        (WORK / "broken").mkdir()
        for library in pathlib.Path("/usr/lib").glob("*/libnetcdf.so.*"):
            (WORK / "broken" / library.name).write_bytes(b"no library")
        with mock.patch.dict(os.environ, LD_LIBRARY_PATH=str(WORK / "broken")):
            for command in ([*GRID, "-o", "x.nc"], ["plot", "read.nc", "-o", "x.svg"]):
                self.assertRegex(self.refused(*command, code=42), r"libnetcdf\.so\.\d+, which cannot be loaded: .*broken.*libnetcdf19")
        self.assertFalse((WORK / "x.nc").exists() or (WORK / "x.svg").exists())


if __name__ == "__main__":
    unittest.main()
