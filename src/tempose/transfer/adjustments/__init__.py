"""Key-framed adjustments layered on a transferred clip.

The files, in the order in which data flows: adjustment, files; curves, parts; chains, layer, adjust.
"""
