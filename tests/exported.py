"""Reads what `rovsim export` writes and moves by it, as the simulators' own pages say they do.

Nothing of rovsim is used here. Each reader takes the text of a file and returns a function
(state (13,), commands (c,), forces N of the thrusters (n,)) -> acceleration (6,) in FRD.
"""

import re
from xml.etree import ElementTree as ET

import numpy as np
import yaml

from matlab import Matrix, functions

HALF = np.diag([1.0, -1.0, -1.0])  # FRD <-> FLU, NED <-> z up
BOTH = np.kron(np.eye(2), HALF)


def skew(r):
    return np.array([[0.0, -r[2], r[1]], [r[2], 0.0, -r[0]], [-r[1], r[0], 0.0]])


def body_to_world(q):
    """Fossen 2021, eq. 2.71: I + 2 eta S(eps) + 2 S(eps)^2."""
    S = skew(q[1:])
    return np.eye(3) + 2.0 * q[0] * S + 2.0 * S @ S


def euler(roll, pitch, yaw):
    """Rotation by roll, then pitch, then yaw about fixed axes (URDF, SDFormat)."""

    def about(axis, angle):
        S = skew(np.eye(3)[axis])
        return np.eye(3) + np.sin(angle) * S + (1.0 - np.cos(angle)) * S @ S

    return about(2, yaw) @ about(1, pitch) @ about(0, roll)


def rigid(mass, center, inertia):
    """Inertia (6, 6) at the origin of a body with that inertia about its centre."""
    S = skew(center)
    corner = inertia - mass * S @ S
    return np.block([[mass * np.eye(3), -mass * S], [mass * S, corner]])


def coriolis(M, nu):
    """C(nu) of Fossen 2021, eq. 6.43."""
    a, b = M[:3, :3] @ nu[:3] + M[:3, 3:] @ nu[3:], M[3:, :3] @ nu[:3] + M[3:, 3:] @ nu[3:]
    return np.block([[np.zeros((3, 3)), -skew(a)], [-skew(a), -skew(b)]])


def push(force, place):
    return np.concatenate([force, np.cross(place, force)])


def floats(text):
    return np.array([float(v) for v in text.split()])


def inertial(link, at):
    """Inertia (6, 6) at the model's origin of a link at a place; its mass and its centre there."""
    mass = float(link.findtext("inertial/mass"))
    center = at + floats(link.findtext("inertial/pose"))[:3]
    i = {term.tag: float(term.text) for term in link.find("inertial/inertia")}
    rows = [["ixx", "ixy", "ixz"], ["ixy", "iyy", "iyz"], ["ixz", "iyz", "izz"]]
    return rigid(mass, center, np.array([[i[k] for k in row] for row in rows])), (mass, center)


def added_mass(link):
    """Of `fluid_added_mass`, which is about the link's origin."""
    M = np.zeros((6, 6))
    for term in link.find("inertial/fluid_added_mass"):
        row, column = ("xyzpqr".index(letter) for letter in term.tag)
        M[row, column] = M[column, row] = float(term.text)
    return M


def stability_derivatives(plugin):
    """Axis, velocity, a second one or None, whether of that the size, and the coefficient."""
    for term in plugin:
        found = re.fullmatch("([xyzkmn])([UVWPQR])(abs)?([UVWPQR])?", term.tag)
        if found:
            second = "UVWPQR".index(found[4]) if found[4] else None
            axis, first = "xyzkmn".index(found[1]), "UVWPQR".index(found[2])
            yield axis, first, second, found[3] is not None, float(term.text)


def damping(terms, v):
    """What the plugin Hydrodynamics makes of them."""
    tau = np.zeros(6)
    for i, j, k, size, value in terms:
        factor = 1.0 if k is None else abs(v[k]) if size else v[k]
        tau[i] += value * factor * v[j]
    return tau


def gz(text):
    """DART with fluid_added_mass, and gz-sim's Buoyancy, Hydrodynamics and Thruster."""
    world = ET.fromstring(text).find("world")
    model = world.find("model")
    gravity = floats(world.findtext("gravity"))
    density = float(world.findtext("plugin/uniform_fluid_density"))
    links = {link.get("name"): link for link in model.iterfind("link")}
    place = {name: floats(link.findtext("pose") or "0 0 0")[:3] for name, link in links.items()}
    bodies = [inertial(link, place[name]) for name, link in links.items()]
    M, added = sum(body[0] for body in bodies), added_mass(links["base_link"])
    box = links["base_link"].find("collision")
    volume = np.prod(floats(box.findtext("geometry/box/size")))
    lifted = floats(box.findtext("pose"))[:3]
    plugins = {p.get("name").rpartition(":")[2]: p for p in model.iterfind("plugin")}
    thrusters = [p for p in model.iterfind("plugin") if p.get("name").endswith("Thruster")]
    joints = {joint.get("name"): joint for joint in model.iterfind("joint")}
    water = list(stability_derivatives(plugins["Hydrodynamics"]))
    current = floats(plugins["Hydrodynamics"].findtext("default_current") or "0 0 0")

    def thrust(plugin, force):
        joint = joints[plugin.findtext("joint_name")]
        axis = floats(joint.findtext("axis/xyz"))
        least, most = (float(plugin.findtext(f"{end}_thrust_cmd")) for end in ("min", "max"))
        along = np.clip(force, least, most) * axis / np.linalg.norm(axis)
        return push(along, place[joint.findtext("child")])

    def accelerate(state, commands, forces):
        R, nu = HALF @ body_to_world(state[3:7]) @ HALF, BOTH @ state[7:]
        v = nu - np.concatenate([R.T @ current, np.zeros(3)])
        tau = -coriolis(M, nu) @ nu - coriolis(added, nu) @ nu + damping(water, v)
        for _, (mass, center) in bodies:
            tau += push(R.T @ (mass * gravity), center)
        tau += push(R.T @ (-density * volume * gravity), lifted)
        tau += sum(thrust(*pair) for pair in zip(thrusters, forces, strict=True))
        return BOTH @ np.linalg.solve(M + added, tau)

    return accelerate


def stonefish(text):
    """A rigid body with weight, buoyancy and pushes; drag and added mass are Stonefish's own."""
    root = ET.fromstring(text)
    base = root.find("robot/base_link")
    gravity = np.array([0.0, 0.0, 9.81])
    density = float(root.find("environment/ocean/water").get("density"))
    mass = float(base.find("mass").get("value"))
    center = floats(base.find("cg").get("xyz"))
    axes = euler(*floats(base.find("cg").get("rpy")))
    M = rigid(mass, center, axes @ np.diag(floats(base.find("inertia").get("xyz"))) @ axes.T)
    volume = np.prod(floats(base.find("dimensions").get("xyz")))
    lifted = floats(base.find("origin").get("xyz"))
    pushes = []
    for actuator in root.iterfind("robot/actuator"):
        origin, specs = actuator.find("origin"), actuator.find("specs")
        along = euler(*floats(origin.get("rpy")))[:, 0]
        limits = float(specs.get("lower_limit")), float(specs.get("upper_limit"))
        pushes.append((push(along, floats(origin.get("xyz"))), limits))

    def accelerate(state, commands, forces):
        R, nu = body_to_world(state[3:7]), state[7:]
        tau = -coriolis(M, nu) @ nu + push(R.T @ (mass * gravity), center)
        tau += push(R.T @ (-density * volume * gravity), lifted)
        for (along, limits), force in zip(pushes, forces, strict=True):
            tau += np.clip(force, *limits) * along
        return np.linalg.solve(M, tau)

    return accelerate


def mss(text):
    """The function of the file, by its name in the first line."""
    function = functions(text)[re.match(r"function .* = (\w+)\(", text)[1]]

    def accelerate(state, commands, forces):
        x = np.concatenate([state[7:], state[:7]])[:, None]
        xdot, speed, _ = function(Matrix(x), Matrix(commands[:, None]))
        assert speed == np.linalg.norm(state[7:10])
        return xdot.a[:6, 0]

    return accelerate


def curve(spec, u):
    """Force of a command by one of the curves of a vehicle file."""
    kind, q = next(iter(spec.items()))
    if kind == "odd_polynomial":
        return sum(a * u ** (2 * k + 1) for k, a in enumerate(q))
    if kind == "table":
        return np.interp(u, q["command"], q["force"])
    share = max(abs(u) - q["deadband"], 0.0) / (1.0 - q["deadband"])
    return (-q["reverse"] if u < 0 else q["forward"]) * share**2


def static(t, unit, u):
    """Force of a thruster at rest, of a command, by what stands in `thrusters`."""
    force = curve(unit["curve"], u if abs(u) > t["deadband"] else 0.0)
    full = unit["full"]["backwards" if force < 0 else "forwards"]
    if full:
        force = np.sign(force) * full * (abs(force) / full) ** t["exponent"]
    force *= unit["gain"]
    return force * (t["backwards"] if force < 0 else 1.0)


def product(name, v):
    """Axis of a product of velocities, and the product, by its SNAME name."""
    factors = re.findall(r"\|.\||.", name[1:])
    if len(factors) == 2 and factors[0] == factors[1] and len(factors[0]) == 1:
        factors[1] = f"|{factors[1]}|"
    values = [(v["uvwpqr".index(factor.strip("|"))], "|" in factor) for factor in factors]
    return "XYZKMN".index(name[0]), np.prod([abs(u) if size else u for u, size in values])


def thrust(t, commands, nu_r):
    """Wrench of the thrusters, of commands and angles in the order of a log."""
    columns, units = iter(commands), t["units"]
    if not units:
        return np.zeros(6)
    logged = {u["name"]: (next(columns), next(columns) if u["turns"] else 0.0) for u in units}
    forces = np.array([static(t, unit, logged[unit["command"]][0]) for unit in units])
    turning = [k for k, unit in enumerate(units) if unit["turns"]]
    angle = np.array([logged[units[k]["name"]][1] for k in turning])
    aside = forces[turning] * np.sin(angle)
    forces[turning] *= np.cos(angle)
    forces = np.concatenate([forces, aside])
    forces -= t["advance"] * abs(forces) * (np.array(t["directions"]) @ nu_r[:3])
    return np.array(t["T"]) @ forces


def fossen(text):
    """The equation that stands in the file's head."""
    p = yaml.safe_load(text)
    c = {name: np.array(v) for name, v in p.items() if isinstance(v, list)}
    free = np.flatnonzero(p["free"])

    def accelerate(state, commands, forces):
        R, nu = body_to_world(state[3:7]), np.where(p["free"], state[7:], 0.0)
        nu_c = R.T @ c["v_c"]
        nu_r = nu - np.concatenate([nu_c, np.zeros(3)])
        nu_c_dot = np.concatenate([-np.cross(nu[3:], nu_c), np.zeros(3)])
        tau = c["MA"] @ nu_c_dot - coriolis(c["MRB"], nu) @ nu - coriolis(c["MA"], nu_r) @ nu_r
        tau -= c["D_linear"] @ nu_r + c["D_quadratic"] @ (abs(nu_r) * nu_r)
        tau += c["constant"] - c["dry_friction"] * np.tanh(nu_r / 0.01)
        for name, value in p["products"].items():
            axis, found = product(name, nu_r)
            tau[axis] += value * found
        down = R[2]
        tau += push(p["W"] * down, c["r_bg"]) - push(p["B"] * down, c["r_bb"])
        roll, pitch = np.arctan2(down[1], down[2]), -np.arcsin(down[0])
        tau[2:5] -= c["waterplane"] * [state[2], roll, pitch]
        tau += thrust(p["thrusters"], commands, nu_r)
        moving, found = np.ix_(free, free), np.zeros(6)
        found[free] = np.linalg.solve((c["MRB"] + c["MA"])[moving], tau[free])
        return found

    return accelerate


READERS = {"gz": gz, "stonefish": stonefish, "mss": mss, "fossen": fossen}
