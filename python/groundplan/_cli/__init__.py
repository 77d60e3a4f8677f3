"""The commands, one module each: ``fill(parser)`` adds its arguments, ``run(arguments)`` does it.

`arguments` has what several commands take, `terminal` is the way to standard output and standard error.
"""
