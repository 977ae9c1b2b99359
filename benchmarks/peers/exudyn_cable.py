"""The cases with EXUDYN: planar ANCF cable elements, and geometrically exact beams for the twisted wire."""

import math

import exudyn as exu
import exudyn.itemInterface as items
import numpy as np

import peer
import references as ref
from references import AREA, AXIAL, BENDING, DAMPING, DENSITY, GREENHILL, LENGTH, MASS, POISSON, PROBE, SPAN, SPEED, TRAVELS, TWISTING, YOUNG


def buckled(elements):
    """Displacements of position and slope from the straight wire to its buckled shape."""
    share, x, y, angle = ref.buckled()
    s = np.linspace(0.0, 1.0, elements + 1)
    return [[np.interp(u, share, x) - u * LENGTH, np.interp(u, share, y), math.cos(a) - 1.0, math.sin(a)]
            for u, a in zip(s, np.interp(s, share, angle))]


class Cable:
    """The wire, straight or as it buckles between the clamps; the slope across the chord is held at clamped ends."""

    def __init__(self, elements, shape=None, damping=0.0, reduced=0):
        self.container = exu.SystemContainer()
        self.system = mbs = self.container.AddSystem()
        self.ground = mbs.AddNode(items.NodePointGround())
        self.origin = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=self.ground, coordinate=0))
        self.nodes, self.cables = [], []
        for i in range(elements + 1):
            start = shape[i] if shape else [0.0] * 4
            self.nodes.append(mbs.AddNode(items.NodePoint2DSlope1(referenceCoordinates=[LENGTH * i / elements, 0.0, 1.0, 0.0],
                                                                  initialCoordinates=start)))
        for i in range(elements):
            self.cables.append(mbs.AddObject(items.ObjectANCFCable2D(
                length=LENGTH / elements, massPerLength=DENSITY * AREA, bendingStiffness=BENDING, axialStiffness=AXIAL,
                bendingDamping=damping * BENDING, axialDamping=damping * AXIAL, nodeNumbers=self.nodes[i:i + 2],
                useReducedOrderIntegration=reduced)))

    def hold(self, node, coordinate, offset=0.0):
        marker = self.system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))
        return self.system.AddObject(items.CoordinateConstraint(markerNumbers=[self.origin, marker], offset=offset))

    def clamp(self):
        for coordinate in (0, 1, 3):
            self.hold(self.nodes[0], coordinate)
            self.hold(self.nodes[-1], coordinate, SPAN - LENGTH if coordinate == 0 else 0.0)

    def touch(self, carrier, place, reach, segments, stiffness):
        """Contact of the circle on a node with the elements within reach of a place along the chord."""
        mbs = self.system
        centre = mbs.AddMarker(items.MarkerNodePosition(nodeNumber=carrier))
        for i, cable in enumerate(self.cables):
            middle = (i + 0.5) * SPAN / len(self.cables)
            if abs(middle - place) > reach:
                continue
            line = mbs.AddMarker(items.MarkerBodyCable2DShape(bodyNumber=cable, numberOfSegments=segments))
            gaps = mbs.AddNode(items.NodeGenericData(initialCoordinates=[0.1] * segments, numberOfDataCoordinates=segments))
            mbs.AddObject(items.ObjectContactCircleCable2D(markerNumbers=[centre, line], nodeNumber=gaps, numberOfContactSegments=segments,
                                                           contactStiffness=stiffness, circleRadius=PROBE, offset=0.0))


def static_settings(steps=1, tolerance=1e-8, defaults=False):
    settings = exu.SimulationSettings()
    settings.staticSolver.numberOfLoadSteps = steps
    if defaults:
        settings.staticSolver.verboseMode = 0
        settings.solution.file.write = False
        return settings
    settings.staticSolver.newton.relativeTolerance = tolerance
    settings.staticSolver.newton.absoluteTolerance = 1e-10
    settings.staticSolver.newton.maxIterations = 50
    settings.staticSolver.discontinuous.maxIterations = 100
    settings.staticSolver.discontinuous.iterationTolerance = 1e-4
    settings.staticSolver.discontinuous.ignoreMaxIterations = False
    settings.staticSolver.verboseMode = 0
    settings.solution.file.write = False
    settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    return settings


def bulge(elements, tolerance=1e-8):
    """The wire at rest between its clamps."""
    cable = Cable(elements, buckled(elements))
    cable.clamp()
    cable.system.Assemble()
    cable.system.SolveStatic(static_settings(tolerance=tolerance))
    state = [list(cable.system.GetNodeOutput(n, exu.OutputVariableType.Coordinates)) for n in cable.nodes]
    return state, cable.system


def first_touch(state, place):
    """Height of the circle's centre where it first touches the wire at rest."""
    elements = len(state) - 1
    h = LENGTH / elements
    highest = []
    for i in range(elements):
        a, b = state[i], state[i + 1]
        u = np.linspace(0.0, 1.0, 401)
        shapes = (2*u**3 - 3*u**2 + 1, -2*u**3 + 3*u**2, (u**3 - 2*u**2 + u) * h, (u**3 - u**2) * h)
        x = shapes[0] * (a[0] + i * h) + shapes[1] * (b[0] + (i + 1) * h) + shapes[2] * (1 + a[2]) + shapes[3] * (1 + b[2])
        y = shapes[0] * a[1] + shapes[1] * b[1] + shapes[2] * a[3] + shapes[3] * b[3]
        near = np.abs(x - place) < PROBE
        highest.append(np.min(y[near] - np.sqrt(PROBE**2 - (x[near] - place)**2), initial=np.inf))
    return min(highest)


def push(elements=60, segments=4, stiffness=1e9, reach=0.010, place=0.065, travels=TRAVELS, tolerance=1e-7, reduced=0, defaults=False):
    state, _ = bulge(elements)
    level = first_touch(state, place)
    cable = Cable(elements, state, reduced=reduced)
    cable.clamp()
    mbs = cable.system
    pusher = mbs.AddNode(items.NodePoint2D(referenceCoordinates=[place, level]))
    mbs.AddObject(items.MassPoint2D(mass=1.0, nodeNumber=pusher))
    cable.hold(pusher, 0)
    marker = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=pusher, coordinate=1))
    largest = travels[-1]

    def travel(system, t, number, offset):
        return largest * t

    drive = mbs.AddObject(items.CoordinateConstraint(markerNumbers=[cable.origin, marker], offsetUserFunction=travel))
    force = mbs.AddSensor(items.SensorObject(objectNumber=drive, outputVariableType=exu.OutputVariableType.Force, storeInternal=True,
                                             writeToFile=False))
    cable.touch(pusher, place, reach, segments, stiffness)
    mbs.Assemble()
    mbs.SolveStatic(static_settings(len(travels), tolerance, defaults))
    data = mbs.GetSensorStoredData(force)
    return {"force_N": [abs(float(v)) for v in data[:, 1]][-len(travels):], "points": len(data)}


def impact(elements=30, step=5e-4, segments=4, stiffness=1e8, reach=0.010, damping=DAMPING, spectral_radius=0.9, modified=True, until=0.3):
    state, _ = bulge(elements)
    gap = 1e-4
    level = first_touch(state, 0.5 * SPAN) - gap
    cable = Cable(elements, state, damping=damping)
    cable.clamp()
    mbs = cable.system
    body = mbs.AddNode(items.NodePoint2D(referenceCoordinates=[0.5 * SPAN, level], initialVelocities=[0.0, SPEED]))
    mbs.AddObject(items.MassPoint2D(mass=MASS, nodeNumber=body))
    cable.touch(body, 0.5 * SPAN, reach, segments, stiffness)
    speed, rate = (mbs.AddSensor(items.SensorNode(nodeNumber=body, outputVariableType=kind, storeInternal=True, writeToFile=False))
                   for kind in (exu.OutputVariableType.Velocity, exu.OutputVariableType.Acceleration))
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = round(until / step)
    settings.timeIntegration.endTime = until
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.generalizedAlpha.spectralRadius = spectral_radius
    settings.timeIntegration.newton.useModifiedNewton = modified
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = step
    settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    mbs.SolveDynamic(settings)
    speeds = mbs.GetSensorStoredData(speed)[:, 2]
    force = -MASS * mbs.GetSensorStoredData(rate)[:, 2]
    return {"peak_N": float(force.max()) if step > 5e-5 else peer.peak(speeds, step, MASS), "impulse_Ns": float(MASS * (SPEED - speeds[-1]))}


def cantilever(elements, load=0.0, reduced=0):
    cable = Cable(elements, reduced=reduced)
    for coordinate in (0, 1, 3):
        cable.hold(cable.nodes[0], coordinate)
    if load:
        tip = cable.system.AddMarker(items.MarkerNodePosition(nodeNumber=cable.nodes[-1]))
        cable.system.AddLoad(items.Force(markerNumber=tip, loadVector=[0.0, load, 0.0]))
    cable.system.Assemble()
    return cable


def tip(elements=16, load=4.0, steps=4, tolerance=1e-8, reduced=0):
    cable = cantilever(elements, load * BENDING / LENGTH**2, reduced)
    cable.system.SolveStatic(static_settings(steps, tolerance))
    place = cable.system.GetNodeOutput(cable.nodes[-1], exu.OutputVariableType.Position)
    return {"tip": [float(place[0]) / LENGTH, float(place[1]) / LENGTH]}


def frequency(elements=16):
    cable = cantilever(elements)
    values = cable.system.ComputeODE2Eigenvalues(convert2Frequencies=True)
    return {"frequency_Hz": float(np.sort(np.abs(values[0]))[0])}


def twisted(elements, moment):
    """Squares of the angular frequencies of the straight wire under a twisting moment at both clamps, which turn about the axis alone.

    The rotation vectors of the nodes must stay below a turn, so that the middle is held and the ends turn to either side.
    """
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    shear = 0.9 * YOUNG / (2 * (1 + POISSON)) * AREA
    turning = BENDING / YOUNG * DENSITY
    section = exu.BeamSection()
    section.stiffnessMatrix = np.diag([AXIAL, shear, shear, TWISTING, BENDING, BENDING])
    section.inertia = np.diag([2 * turning, turning, turning])
    section.massPerLength = DENSITY * AREA
    h = LENGTH / elements
    nodes = [mbs.AddNode(items.NodeRigidBodyRotVecLG(referenceCoordinates=[i * h, 0, 0, 0, 0, 0])) for i in range(elements + 1)]
    for i in range(elements):
        mbs.AddObject(items.ObjectBeamGeometricallyExact(nodeNumbers=nodes[i:i + 2], length=h, sectionData=section))
    ground = mbs.AddObject(items.ObjectGround())
    for index, held, torque in ((0, [1, 1, 1, 0, 1, 1], -moment), (elements // 2, [0, 0, 0, 1, 0, 0], 0.0), (elements, [1, 1, 1, 0, 1, 1], moment)):
        there = mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=ground, localPosition=[index * h, 0, 0]))
        here = mbs.AddMarker(items.MarkerNodeRigid(nodeNumber=nodes[index]))
        mbs.AddObject(items.GenericJoint(markerNumbers=[there, here], constrainedAxes=held))
        if torque:
            mbs.AddLoad(items.Torque(markerNumber=here, loadVector=[torque, 0, 0]))
    mbs.Assemble()
    mbs.SolveStatic(static_settings(10, 1e-6))
    mbs.systemData.SetSystemState(mbs.systemData.GetSystemState(), configuration=exu.ConfigurationType.Initial)
    return np.sort(np.real(mbs.ComputeODE2Eigenvalues(useAbsoluteValues=False)[0]))


def twist(elements=32):
    return {"critical": peer.critical([float(twisted(elements, share * GREENHILL)[0]) for share in peer.SHARES])}


if __name__ == "__main__":
    peer.main(globals())
