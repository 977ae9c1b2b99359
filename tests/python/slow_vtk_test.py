"""The ParaView files of a motion in VTK's own reader: arrays, their units, and their values beside history.csv.

Needs the package vtk of the Python index, in the Python of the tests or in a folder that SNARE_PEER_PACKAGES names; skipped, saying
so, where there is none.
"""

import csv
import pathlib
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import setting
import numpy as np

setting.add_peer_packages()
try:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
except ImportError as reason:
    print(f"skipped: the package vtk is not installed ({reason})")
    sys.exit(setting.SKIPPED)

POINTS = {"tension_N": 1, "curvature_1_m": 1, "contact_force_N": 3, "velocity_m_s": 3}


def read(path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def columns(path):
    with open(path) as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    return {name: np.array([float(row[k]) for row in rows[1:]]) for k, name in enumerate(rows[0])}


class InVtk(unittest.TestCase):
    def frames(self, scenario, out, *arguments):
        setting.run_command("simulate", str(setting.SOURCE / "data/scenarios" / scenario), "--out", out, "--set", "output.paraview=true", *arguments)
        root = xml.etree.ElementTree.parse(pathlib.Path(out) / "motion.pvd").getroot()
        return [(float(one.get("timestep")), read(pathlib.Path(out) / one.get("file"))) for one in root.iter("DataSet")]

    def check_arrays(self, time, data):
        for name, components in POINTS.items():
            array = data.GetPointData().GetArray(name)
            self.assertIsNotNone(array, name)
            self.assertEqual((array.GetNumberOfTuples(), array.GetNumberOfComponents()), (data.GetNumberOfPoints(), components))
            self.assertTrue(np.isfinite(vtk_to_numpy(array)).all(), name)
        cells = data.GetCellData()
        for name in ("kind", "number"):
            self.assertEqual(cells.GetArray(name).GetNumberOfTuples(), data.GetNumberOfCells())
        names = cells.GetAbstractArray("name")
        self.assertEqual(names.GetNumberOfValues(), data.GetNumberOfCells())
        self.assertEqual(data.GetFieldData().GetAbstractArray("coordinates_unit").GetValue(0), "m")
        self.assertAlmostEqual(data.GetFieldData().GetArray("TimeValue").GetValue(0), time, delta=1e-8)
        return [(int(vtk_to_numpy(cells.GetArray("kind"))[k]), int(vtk_to_numpy(cells.GetArray("number"))[k]), names.GetValue(k))
                for k in range(data.GetNumberOfCells())]

    def points_of(self, data, cell):
        ids = data.GetCell(cell).GetPointIds()
        return [ids.GetId(k) for k in range(ids.GetNumberOfIds())]

    def test_a_body_on_a_wire(self):
        with tempfile.TemporaryDirectory() as out:
            frames = self.frames("air_table.toml", out, "--set", "duration_s=0.05")
            history = columns(pathlib.Path(out) / "history.csv")
            largest = 0.0
            for k, (time, data) in enumerate(frames):
                kinds = self.check_arrays(time, data)
                self.assertEqual(kinds[0], (0, 0, "wire"))
                self.assertTrue(all(kind == 1 for kind, _, _ in kinds[1:]))
                wire = self.points_of(data, 0)
                contact = vtk_to_numpy(data.GetPointData().GetArray("contact_force_N"))
                tension = vtk_to_numpy(data.GetPointData().GetArray("tension_N"))
                velocity = vtk_to_numpy(data.GetPointData().GetArray("velocity_m_s"))
                largest = max(largest, np.linalg.norm(contact[wire].sum(axis=0)))
                if k == 0:
                    body = self.points_of(data, 1)
                    self.assertLess(np.abs(velocity[body] - [0.0, 0.1, 0.0]).max(), 1e-6)
                force = np.array([history[f"probe on wire f{axis}_N"][k] for axis in "xyz"])
                self.assertLess(np.abs(contact[wire].sum(axis=0) - force).max(), 1e-6 * (1.0 + np.abs(force).max()))
                # The history has the smaller part of the mounts' forces along the ends; half an edge has little inertia.
                ends = min(tension[wire[0]], tension[wire[-1]])
                self.assertAlmostEqual(ends, history["wire tension_N"][k], delta=0.01 * abs(ends) + 0.1)
                self.assertEqual(np.abs(contact[wire[-1] + 1:]).max(), 0.0)
            self.assertGreater(largest, 0.5)  # it was touched
            # Velocities are those of the motion: the path over a step is their mean times the step.
            first, second = frames[-2][1], frames[-1][1]
            x0, x1 = (vtk_to_numpy(d.GetPoints().GetData()) for d in (first, second))
            v0, v1 = (vtk_to_numpy(d.GetPointData().GetArray("velocity_m_s")) for d in (first, second))
            body = self.points_of(first, 1)
            step = frames[-1][0] - frames[-2][0]
            self.assertLess(np.abs((x1 - x0)[body] / step - 0.5 * (v0 + v1)[body]).max(), 1e-3 * np.abs(v0[body]).max())

    def test_an_arm_and_a_snare(self):
        with tempfile.TemporaryDirectory() as out:
            frames = self.frames("ssrms_htv_capture.toml", out, "--set", "duration_s=0.02")
            kinds = {kind for time, data in frames for kind, _, _ in self.check_arrays(time, data)}
            self.assertEqual(kinds, {0, 1, 2})


if __name__ == "__main__":
    setting.main()
