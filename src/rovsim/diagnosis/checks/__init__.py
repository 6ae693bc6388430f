"""Checks of the runs, and of the values of an answer.

standstills       stretches in which the vehicle stands still although the model would move
disturbed_ends    ends of runs that leave far more than the rest: moved by hand
commanded         thrusters or axes that were never commanded
observability     effects that these runs could not show
unlogged_effects  removes effects that only explain where the command log is uncertain
feedback_axes     axes on which an autopilot knows more than the cameras, and what shows there
by_run            products of derivatives and innovations, run by run
varying_effects   accepted effects whose values vary from run to run
run_differences   an effect that has another value in each run
needless_effects  accepted effects that nothing asks for once runs differ
clocks            runs whose commands have another clock, found without a model
wrong_units       values so far from the vehicle file that a unit may be wrong
noise_floor       the error that a perfect model would have
"""
