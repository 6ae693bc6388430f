"""From files that nobody has described to a `campaign.yaml` that a person can finish.

survey         finds what is in files: formats, motions, commands, units
collect_files  looks into all files; gives one message for each that cannot be used
one_unit       makes sure that columns of one name have one unit in all files
names          reads from file names: runs, and which files belong together
together       puts together files of one run that hold different sensors
bodies         which body or topic is the vehicle, where a file holds several
vehicles       which vehicle files fit the commands
motions        compares all motions with all logs, for each vehicle that it may be
pairing        finds the commands of each motion: by name, by clock, by the motion they cause
choice         chooses the vehicle whose motion the recordings resemble
axes           finds which way the axes of world and body point
checks         finds what looks wrong: clocks, mirrored axes, thrusters in another order, gaps
facts          puts all of this together
draft          a proposal in the making: content, comments and questions by place
spans          finds runs that stand one after the other in one file
runs           proposes the runs: names, control, split and files
sections       proposes the other sections: what is known, guessed, or asked
proposal       a campaign.yaml in the making, with what is left to ask
unread         names columns that nothing uses
places         where the recordings lie beside the campaign.yaml
compose        from files to a proposal, all steps together
guesses        lists what was taken, and what of it is a guess
yaml_file      writes the proposal as commented YAML
write          writes campaign.yaml, beside the copies that it needs
"""
