"""Simulates models under commands: replays of runs, single steps, and a synthetic tank.

settings               how runs are replayed
step_grid              the integration steps of a run
command_columns        which columns of a log are angles
drive                  forces and demands of a model, over steps or at instants
rest                   where runs begin that nobody measured
correction             readings, and the filters that correct models by them
packed_models          models side by side, as the compiled engine reads them
batch                  the only way into the compiled engine: models, drives, starts to trajectories
compiled_ahead         compiles the engines that a diagnosis needs later, in another process
initial_memory         the state of a fluid memory where a replay starts
windows                where replays start again from the measured state
filter_padding         motion before and after a window, so that the filter has no edge there
unfiltered_motion      the motion before the software of a motion capture smoothed it
unmeasured_velocities  velocities at the start of a window where none were measured
measured_states        the acceleration of a model at the measured states
prediction             what a replay returns: poses, velocities and accelerations of each horizon
replay                 a model driven from measured states: windows, and open loop
noise_draws            random disturbances, and random errors of the measurement
bands                  the range in which a measured run should lie
samples                the acceleration that a model lacks, from which residuals learn
stepper                one step at a time, in somebody else's loop
ensemble               steps many possible models side by side, which give a band
synthetic_tank         campaigns as raw exports, with the truth beside them
"""
