"""The code inside the unit: a `Stepper` behind FMI's variables. It is packed as it stands."""

from pathlib import Path
from xml.etree.ElementTree import SubElement

import numpy as np
from pythonfmu import Fmi2Causality, Fmi2Initial, Fmi2Slave, Fmi2Variability, Real

from rovsim.dynamics.catalogue import load_catalogue
from rovsim.dynamics.model_file import read_model
from rovsim.simulation.stepper import Stepper

STATE_NAMES = ("x", "y", "z", "q0", "q1", "q2", "q3", "u", "v", "w", "p", "q", "r")
MODEL_FILE = "model.yaml"  # among the unit's resources


class Vehicle(Fmi2Slave):
    """A vehicle in water; SI units, NED, body axes FRD at CO, quaternion q0..q3 body to world.

    Parameters `start_x` … are the initial state, inputs `command_1` … the thrusters' commands in
    [-1, 1], which are held over a step, and outputs `x` … the state.
    """

    def __init__(self, **given):
        super().__init__(**given)
        self.description = "An underwater vehicle simulated by rovsim"
        self.stepper = Stepper(read_model(Path(self.resources, MODEL_FILE), load_catalogue()))
        self.state = np.zeros(13)
        self.start = np.array([float(name == "q0") for name in STATE_NAMES])
        self.command = np.zeros(self.stepper.columns)
        for i in range(self.stepper.columns):
            self._real(f"command_{i + 1}", Fmi2Causality.input, self.command, i)
        for i, name in enumerate(STATE_NAMES):
            fixed = Fmi2Variability.tunable
            self._real(f"start_{name}", Fmi2Causality.parameter, self.start, i, variability=fixed)
        for i, name in enumerate(STATE_NAMES):
            begins = Fmi2Initial.calculated
            self._real(name, Fmi2Causality.output, self.state, i, initial=begins)

    def to_xml(self, *options):
        """Return the description of the unit, with the outputs listed as initial unknowns.

        pythonfmu 0.7 leaves these out; pythonfmu3 does not, but few tools read its FMI 3.0.
        """
        root = super().to_xml(*options)
        structure = root.find("ModelStructure")
        unknowns = SubElement(structure, "InitialUnknowns")
        for output in structure.iterfind("Outputs/Unknown"):
            SubElement(unknowns, "Unknown", attrib=dict(output.attrib))
        return root

    def _real(self, name, causality, array, i, **more):
        """Register a variable whose value is an element of an array."""
        self.register_variable(
            Real(
                name,
                causality=causality,
                getter=lambda: float(array[i]),
                setter=lambda value: array.__setitem__(i, value),
                **more,
            )
        )

    def exit_initialization_mode(self):
        """Set the state to that of the start parameters."""
        self.stepper.reset()
        self.state[:] = self.start

    def do_step(self, current_time, step_size):
        """Simulate a step of `step_size` s, over which the commands are held."""
        self.state[:] = self.stepper.step(self.state, self.command, step_size)
        return True
