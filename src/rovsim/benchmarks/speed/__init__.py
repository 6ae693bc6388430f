"""How fast replay and inference are here, beside the libraries: one honest run, machines differ.

data       what is learnt and asked
libraries  the libraries' own calls
inference  latency of every way to predict
replay     steps per second
accuracy   error against cost
machine    how a control loop would run on this machine
tables     the table of docs/benchmark_speed.md
plots      and its plots
"""
