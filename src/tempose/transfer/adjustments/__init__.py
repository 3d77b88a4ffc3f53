"""Key-framed adjustments layered on a transferred clip.

The files, in the order in which data flows: adjustment, files; parts, chains, limb_chain, turn_chain, groups;
curves, wanted; posing, part_fields, layer; adjust, on_result.
"""
