"""The equation of motion of a vehicle, and all effects that may act in it. Knows no recording.

model             a vehicle with effects that add up, and perhaps a trained residual
model_file        reads and writes a model as YAML
effect_entry      an effect as a model file has it
catalogue         every effect that a model file can name and a diagnosis can find
vehicle           a vehicle file, and the nominal effects that it stands for
effects           the effects, one family a file, and what an effect is
laws              what a diagnosis may propose where no effect explains the motion
user_effects      effects that a user wrote: read, checked and tried
body              the constants of Fossen's equation, which effects fill in
actuation         from logged commands to the force of each thruster over each step
step_cuts         integration steps, cut where a line of the command log takes effect
mocap_view        what the motion capture reports of a true motion
low_pass          the low-pass filters by which a motion capture may smooth
uncertainty       how sure the fitted values of a model are
parameter_labels  parameters as readers know them: with the names of thrusters
engine            the equation of motion, compiled
learned           a trained residual inside the integration loop
compilation       how functions are compiled, and where the code is cached
"""
