"""The equation of motion. Knows no recording.

model         a vehicle, effects that add, perhaps a trained residual
model_file    the same as a file
effect_entry  an effect as files name it
catalogue     every effect that a model file can name and a diagnosis can find
vehicle       what a vehicle file says, and the nominal effects it stands for
effects       the effects, one family a file
body          the constants of Fossen's equation, which effects fill in
actuation     from logged commands to the force of each thruster over each step
step_cuts     steps cut where a line of the log takes effect
mocap_view    what the motion capture reports of a true motion
low_pass      low-passes by which it smooths
uncertainty   what a model leaves open
engine        the equation, compiled
learned       a trained residual inside the loop
"""
