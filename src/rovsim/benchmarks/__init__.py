"""How fast it is, and whether physics hidden in a tank is found.

blind    hides physics in a tank, asks methods what is missing, and scores their answers
designs  do designed flights tell what they promise?
speed    how fast replay and inference are, beside other libraries
"""
