"""From files that nobody has described to a `campaign.yaml` that a person can finish.

survey         what is in files: formats, motions, commands, units
collect_files  all files: what they hold, or one message for each that cannot be used
one_unit       columns of one name have one unit in all files
names          what their names say: runs, and which files belong together
together       files of one run that hold different sensors
bodies         which body or topic is the vehicle, where a file holds several
vehicles       which vehicle files fit the commands
motions        all motions and logs beside each other, for each vehicle that may be it
pairing        which commands belong to which motion: by name, by clock, by what they cause
choice         which of the vehicles the motion is like
axes           which way the axes of world and body point
checks         what looks wrong: clocks, mirrored axes, thrusters in another order, gaps
facts          all of that together
draft          a proposal in the making: content, comments and questions by place
spans          runs that stand one after the other in one file
runs           the runs of a proposal: names, control, split and files
sections       the other sections: what is known, what is guessed, what is asked
proposal       what is known, and what is left to ask
unread         columns of their files that nothing uses
places         where the recordings lie beside the file
compose        from files to a proposal
guesses        what was taken, and what of it is a guess, for the terminal and the workbench
yaml_file      the proposal as a commented campaign.yaml
write          that file, beside the copies it needs
"""
