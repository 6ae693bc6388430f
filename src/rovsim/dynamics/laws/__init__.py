"""Laws that a diagnosis may propose for what no effect of the catalogue explains, as effects.

law            any law of up to three terms, its terms as data
codes          codes of the factors of its terms
thrust_law     a push that follows the thrust
wake_by_axis   a fluid memory with a coefficient for each axis
propeller_lag  propellers that take time to change their speed
thruster_play  thrusters that do not answer small changes
thruster_rate  thrusters whose force, or speed, changes at a limited rate
"""
