"""law.py in Drake, whose parser of MJCF ignores tendons: a force of ten lines, at travels below, within and beyond the range, and an impact.

Needs the package drake of the Python index, in the Python of the tests or in a folder that SNARE_PEER_PACKAGES names; skipped, saying
so, where there is none.
"""

import importlib.util
import pathlib
import sys
import tempfile
import unittest
import warnings

import setting
import snare
import numpy as np

setting.add_peer_packages()
try:
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
    from pydrake.multibody.tree import PrismaticJoint, SpatialInertia, UnitInertia
    from pydrake.systems.analysis import Simulator
    from pydrake.systems.framework import DiagramBuilder, LeafSystem
except ImportError as reason:
    print(f"skipped: the package drake is not installed ({reason})")
    sys.exit(setting.SKIPPED)

POSITION, SLACK, MASS = 0.0525, 0.49e-3, 8.9


class Wire(LeafSystem):
    """The force of a law on one slide joint: from its position and velocity to its generalised force."""

    def __init__(self, law):
        super().__init__()
        state = self.DeclareVectorInputPort("state", 2)
        self.DeclareVectorOutputPort("force", 1, lambda context, force: force.SetFromVector([-law.force(state.Eval(context)[0], POSITION, SLACK)]))


class InDrake(unittest.TestCase):
    def test_the_law_as_a_force(self):
        warnings.simplefilter("ignore")
        with tempfile.TemporaryDirectory() as name:
            setting.run_command("distil", str(setting.small_wire(name)), "--out", name, "--set", "laws.positions_mm=[52.5]", "--set", "laws.displacement_offsets_mm=[0.0]")
            spec = importlib.util.spec_from_file_location("law", pathlib.Path(name) / "law.py")
            module = importlib.util.module_from_spec(spec)
            spec.loader.exec_module(module)
            law = snare.Law(pathlib.Path(name) / "law.json")
        builder = DiagramBuilder()
        plant, _ = AddMultibodyPlantSceneGraph(builder, 0.0)
        body = plant.AddRigidBody("visitor", SpatialInertia(MASS, np.zeros(3), UnitInertia.SolidSphere(0.05)))
        joint = plant.AddJoint(PrismaticJoint("along", plant.world_frame(), body.body_frame(), [0.0, 1.0, 0.0]))
        plant.mutable_gravity_field().set_gravity_vector(np.zeros(3))
        plant.Finalize()
        wire = builder.AddSystem(Wire(module))
        builder.Connect(plant.get_state_output_port(), wire.get_input_port())
        builder.Connect(wire.get_output_port(), plant.get_applied_generalized_force_input_port())
        diagram = builder.Build()
        simulator = Simulator(diagram)
        context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
        end = law.travel[1]
        largest = law.force(2.0 * end, POSITION)
        for d in np.linspace(-end, 2.0 * end, 31):
            joint.set_translation(context, d)
            got = -wire.get_output_port().Eval(wire.GetMyContextFromRoot(simulator.get_context()))[0]
            self.assertAlmostEqual(got, law.force(d, POSITION, SLACK) if d >= 0.0 else 0.0, delta=1e-6 * largest)
        joint.set_translation(context, -1e-3)
        joint.set_translation_rate(context, 0.02)
        simulator.get_mutable_integrator().set_target_accuracy(1e-8)
        simulator.AdvanceTo(0.5)
        self.assertAlmostEqual(joint.get_translation_rate(context), -0.02, delta=2e-5)  # elastic


if __name__ == "__main__":
    setting.main()
