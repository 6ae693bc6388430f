"""A loose vehicle file, whose drag, added mass, buoyancy and thrust may all be a little wrong.

loose_file       judges a special effect beside all values of a loose file, to first order
steps            removes special effects that the file explains about as well
whole_file       fits all values of a loose file together with the accepted effects
special_effects  judges each special effect beside such a fit
"""
