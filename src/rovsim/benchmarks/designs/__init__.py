"""Do designed flights keep their promise? Each is flown in the tank beside the best usual one.

    python -m rovsim.benchmarks.designs development|reporting OUT [CASE…]

A case hides one effect in a rough run of 20 s, asks for a flight of 60 s (which of two effects is
it, or how large is it), and flies that and the usual manoeuvre that would tell most. Then either
is fitted beside the run. One JSON a case in OUT; those that are there are kept. Ends with a table.

cases          which cases there are, what each hides and asks
designed_case  a case whose flight is planned
flight         a flight in the tank, and what it told
run            a case from its run to its result
table          the table
"""
