"""pyPBD's falling strands: its direct solver for stiff rods (Deul et al. 2018), one iteration a step."""

from falling import LENGTH, LINEAR_DENSITY, RADIUS, Strand, arguments, measure, report

import os
import subprocess
import sys

import numpy as np
import pypbd as pbd

METHOD = "pypbd-direct-it1"
# Segments lie along their own y, turned onto x: as rows of the matrix and as a quaternion x, y, z, w.
TURN = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
TURN_QUATERNION = np.array([0.0, 0.0, -np.sqrt(0.5), np.sqrt(0.5)])
# From one strand to the next, in m.
APART = 0.05


class Strands:
    """Strands of rigid segments side by side. The middle of the first lies in the clamp and doesn't move."""

    def __init__(self, strand, strands, step):
        self.elements = strand.elements
        self.segment = LENGTH / (strand.elements - 0.5)
        self.simulation = pbd.Simulation.getCurrent()
        self.simulation.initDefault()
        self.model = self.simulation.getModel()
        pbd.TimeManager.getCurrent().setTimeStepSize(step)
        self.stepper = self.simulation.getTimeStep()
        controller = pbd.TimeStepController
        self.stepper.setValueUInt(controller.NUM_SUB_STEPS, 1)
        self.stepper.setValueUInt(controller.MAX_ITERATIONS, 1)
        self.stepper.setValueUInt(controller.MAX_ITERATIONS_V, 0)
        for number in range(strands):
            self.hang(strand, number * APART)

    def hang(self, strand, aside):
        count, segment = self.elements, self.segment
        first = len(self.model.getRigidBodies())
        for number in range(count):
            self.add_segment(np.array([number * segment, 0.0, aside]), is_fixed=number == 0)
        joints = range(count - 1)
        added = self.model.addDirectPositionBasedSolverForStiffRodsConstraint(
            [(first + i, first + i + 1) for i in joints],
            [np.array([(i + 0.5) * segment, 0.0, aside]) for i in joints],
            [RADIUS] * len(joints),
            [segment] * len(joints),
            [strand.young] * len(joints),
            [strand.shear] * len(joints),
        )
        if not added:
            raise RuntimeError("pyPBD refuses the rod")

    def add_segment(self, place, is_fixed):
        mass = LINEAR_DENSITY * self.segment
        across = mass * (self.segment**2 / 12 + RADIUS**2 / 4)
        vertices, mesh = tiny_tetrahedron()
        body = self.model.addRigidBody(1.0, vertices, mesh, place, TURN, np.ones(3), False, False)
        # The body is moved to its mesh's centre of mass and main axes, and has the mesh's mass: all that is set anew.
        for put in (body.setPosition, body.setPosition0, body.setOldPosition, body.setLastPosition):
            put(place)
        for turn in (body.setRotation, body.setRotation0, body.setOldRotation, body.setLastRotation):
            turn(TURN_QUATERNION)
        body.setMass(0.0 if is_fixed else mass)
        body.setInertiaTensor(np.array([across, mass * RADIUS**2 / 2, across]))
        body.rotationUpdated()

    def tip(self):
        body = self.model.getRigidBodies()[self.elements - 1]
        along = np.array(body.getRotationMatrix())[:, 1]
        return np.array(body.getPosition()).ravel() + along * self.segment / 2


def tiny_tetrahedron():
    """A mesh, which every rigid body must have."""
    corners = 1e-3 * np.array([[-1.0, -1.0, -1.0], [1.0, -1.0, -1.0], [0.0, 1.0, -1.0], [0.0, 0.0, 1.0]])
    faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
    vertices, mesh = pbd.VertexData(), pbd.IndexedFaceMesh()
    for corner in corners:
        vertices.addVertex(corner)
    mesh.initMesh(len(corners), 2 * len(faces), len(faces))
    for face in faces:
        mesh.addFace(list(face))
    mesh.buildNeighbors()
    return vertices, mesh


def fall(strands, steps):
    """The time and the tips of the strands' fall."""

    def advance():
        for _ in range(steps):
            strands.stepper.step(strands.model)
        # The strand can't reach farther than its length, but stretches where steps are long.
        return bool(np.abs(strands.tip()).max() < 10 * LENGTH)

    return measure(strands.simulation.reset, advance, strands.tip)


if __name__ == "__main__":
    options = arguments()
    if len(options.steps) > 1:
        # There is one simulation a process.
        fixed = ["--elements", options.elements, "--gamma", options.gamma, "--strands", options.strands]
        for steps in options.steps:
            line = [sys.executable, __file__, *map(str, fixed), "--steps", str(steps)]
            subprocess.run(line, check=True)
    else:
        (steps,) = options.steps
        strands = Strands(Strand(options.elements, options.gamma), options.strands, 1 / 24 / steps)
        report(METHOD, steps, options.strands, fall(strands, steps))
        sys.stdout.flush()
        os._exit(0)  # Its modules crash when they are taken down in the usual order.
