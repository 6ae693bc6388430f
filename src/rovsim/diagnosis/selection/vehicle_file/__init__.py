"""A vehicle file that is off: drag, added mass, buoyancy and gain of thrust that it states.

stated           what it states, as terms that may be wrong, and how far such files are off
uncertain_file   a special effect beside a file that may be off everywhere, to first order
steps            what the file explains as well as something rarer
whole_file       all of a file that is off, fitted with what was selected
special_effects  each judged beside that
refit            the file fitted alone: a step of the ladder to compare with
"""
