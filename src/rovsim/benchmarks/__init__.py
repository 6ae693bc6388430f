"""How fast it is, and whether physics hidden in a tank is found.

blind    hide physics in the tank, ask what is missing, keep the score
designs  do designed flights keep their promise?
speed    how fast replay and inference are, beside other libraries
"""
