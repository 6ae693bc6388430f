"""A loose vehicle file: drag, added mass, buoyancy and gain of thrust that it states are off.

loose_file       a special effect beside a file that may be off everywhere, to first order
steps            what the file explains as well as something rarer
whole_file       all of a loose file, fitted with what was selected
special_effects  each judged beside that
"""
