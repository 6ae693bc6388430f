"""Models driven by commands: replay, one step at a time, and a synthetic tank.

settings               how runs are replayed
step_grid              the integration steps of a run
command_columns        which columns of a log are angles
drive                  what commands make of thrusters, over steps or at instants
rest                   where runs begin that nobody measured
batch                  the one way into the compiled engine: models, drives, starts to trajectories
compiled_ahead         what a diagnosis needs later, compiled meanwhile in another process
initial_memory         what the water remembers where a replay starts
windows                where replays start anew
filter_padding         what of a run is replayed beside a window, so that a filter finds no edge
unfiltered_motion      the motion behind what a smoothing motion capture reports
unmeasured_velocities  velocities that nobody measured
measured_states        a model at the measured states: it only accelerates
prediction             what a replay returns
replay                 a model driven from measured states: windows, and open loop
noise_draws            what no model foresees, drawn at random
bands                  within what a replay may lie
samples                what the acceleration misses, sample by sample: what residuals learn from
stepper                one step at a time, in somebody else's loop
ensemble               the same, with how sure it is
synthetic_tank         campaigns as raw exports, with the truth beside them
"""
