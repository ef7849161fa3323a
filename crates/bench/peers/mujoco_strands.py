"""MuJoCo's falling strands: a chain of rigid links, and its discrete elastic rod."""

from falling import GRAVITY, LENGTH, LINEAR_DENSITY, RADIUS, Strand, arguments, measure, report

import mujoco
import numpy as np
from xml.etree.ElementTree import Element, SubElement, tostring


def numbers(*values):
    """As MJCF writes them."""
    return " ".join(f"{value:.12g}" for value in values)


def scene(step):
    """An empty scene and the body that all others are fixed to. Z is up."""
    root = Element("mujoco")
    option = SubElement(root, "option", timestep=numbers(step), integrator="discrete", tolerance="1e-10")
    option.set("gravity", numbers(0, 0, -GRAVITY))
    SubElement(option, "flag", contact="disable")
    SubElement(root, "size", memory="1G")
    return root, SubElement(root, "worldbody")


class Chain:
    """Links that turn in ball joints, each with the bending stiffness of the element around it."""

    method = "mujoco-chain-discrete"

    def __init__(self, strand, strands, step):
        root, world = scene(step)
        for number in range(strands):
            self.hang(world, strand, f"tip{number}")
        self.model = mujoco.MjModel.from_xml_string(tostring(root, encoding="unicode"))
        self.data = mujoco.MjData(self.model)

    @staticmethod
    def hang(world, strand, tip):
        link = LENGTH / strand.elements
        mass = LINEAR_DENSITY * link
        along = mass * RADIUS**2 / 2
        across = mass * (link**2 / 12 + RADIUS**2 / 4)
        body = world
        for number in range(strand.elements):
            # The clamp's joint bends half an element only.
            stiffness = strand.bending / link * (2 if number == 0 else 1)
            body = SubElement(body, "body", pos=numbers(link if number else 0, 0, 0))
            SubElement(body, "joint", type="ball", stiffness=numbers(stiffness))
            inertial = SubElement(body, "inertial", pos=numbers(link / 2, 0, 0), mass=numbers(mass))
            inertial.set("diaginertia", numbers(along, across, across))
        SubElement(body, "site", name=tip, pos=numbers(link, 0, 0))

    def tip(self):
        return self.data.site("tip0").xpos


class Rod:
    """The one-dimensional flex, whose edges are kept from stretching by constraints."""

    method = "mujoco-flexN-discrete"

    def __init__(self, strand, strands, step):
        if strands != 1:
            raise ValueError("one rod at a time")
        root, world = scene(step)
        # The clamp lies in the middle of the first edge, whose ends are pinned: so bending is of second order there.
        link = LENGTH / strand.elements
        free = np.linspace(link / 2, LENGTH, strand.elements)
        places = np.concatenate([[-link / 2], free])
        edges = np.diff(places)
        rod = SubElement(world, "flexcomp", name="rod", type="direct", dim="1", radius=numbers(RADIUS))
        rod.set("point", numbers(*(x for place in places for x in (place, 0, 0))))
        rod.set("element", " ".join(f"{i} {i + 1}" for i in range(len(edges))))
        rod.set("mass", numbers(LINEAR_DENSITY * edges.sum()))
        # Constraints as hard as the step allows.
        stiff = {"solref": numbers(max(2 * step, 1e-4), 1), "solimp": numbers(0.9999, 0.9999, 0.001)}
        SubElement(rod, "edge", equality="true", **stiff)
        SubElement(rod, "elasticity", young=numbers(strand.young), shear=numbers(strand.shear))
        SubElement(rod, "pin", id="0 1")
        SubElement(rod, "contact", selfcollide="none")
        self.model = mujoco.MjModel.from_xml_string(tostring(root, encoding="unicode"))
        # Each vertex has the mass of half of its edges.
        masses = LINEAR_DENSITY * (np.append(edges, 0) + np.insert(edges, 0, 0)) / 2
        for body, mass in zip(self.model.flex_vertbodyid, masses):
            if body > 0:
                self.model.body_mass[body] = mass
        self.data = mujoco.MjData(self.model)
        mujoco.mj_setConst(self.model, self.data)

    def tip(self):
        return self.data.flexvert_xpos[-1]


BROKEN = [mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC]


def fall(scene, steps):
    """The time and the tips of a scene's fall."""
    model, data = scene.model, scene.data

    def restart():
        mujoco.mj_resetData(model, data)
        mujoco.mj_forward(model, data)

    def advance():
        mujoco.mj_step(model, data, steps)
        return not any(data.warning[kind].number for kind in BROKEN)

    def tip():
        # A step ends with new coordinates, but with the places from before it.
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_flex(model, data)
        x, y, z = scene.tip()
        return x, z, -y

    return measure(restart, advance, tip)


if __name__ == "__main__":
    options = arguments()
    strand = Strand(options.elements, options.gamma)
    for kind in [Chain, Rod] if options.strands == 1 else [Chain]:
        for steps in options.steps:
            scene_now = kind(strand, options.strands, 1 / 24 / steps)
            report(kind.method, steps, options.strands, fall(scene_now, steps))
