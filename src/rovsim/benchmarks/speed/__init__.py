"""How fast replay and inference are here, beside the libraries: one honest run, machines differ.

data       what is learned and predicted
libraries  how other libraries make the same predictions
inference  latency of every way to predict
replay     integration steps per second
accuracy   error against cost
machine    how regularly a control loop would run on this machine
tables     the table of docs/benchmark_speed.md
plots      plots of docs/benchmark_speed.md
"""
