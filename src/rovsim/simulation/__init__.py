"""Models driven by commands: replay, one step at a time, and a synthetic tank.

settings               how runs are replayed
step_grid              the integration steps of a run
command_columns        which columns of a log are angles
drive                  forces and demands of a model, over steps or at instants
rest                   where runs begin that nobody measured
correction             readings, and the filters that correct models by them
batch                  the only way into the compiled engine: models, drives, starts to trajectories
compiled_ahead         compiles what a diagnosis needs later, meanwhile, in another process
initial_memory         the state of a fluid memory where a replay starts
windows                where replays start again from the measured state
filter_padding         what is simulated beside a window, so that the filter has no edge there
unfiltered_motion      the motion before the software of a motion capture smoothed it
unmeasured_velocities  at the start of a window: those of the model itself
measured_states        the acceleration of a model at the measured states
prediction             what a replay returns
replay                 a model driven from measured states: windows, and open loop
noise_draws            random disturbances, and random errors of the measurement
bands                  the range in which a measured run should lie
samples                the acceleration that a model lacks, from which residuals learn
stepper                one step at a time, in somebody else's loop
ensemble               the same for many possible models, which give a band
synthetic_tank         campaigns as raw exports, with the truth beside them
"""
