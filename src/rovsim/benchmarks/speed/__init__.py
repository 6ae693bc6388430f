"""How fast replay and inference are, beside other libraries, on the machine that runs this.

data       what is learned and predicted
libraries  how other libraries make the same predictions
inference  latency of every way to predict
replay     integration steps per second
accuracy   error against cost
machine    runs the benchmark at the priority of a control loop
tables     the table of docs/benchmark_speed.md
plots      plots of docs/benchmark_speed.md
"""
