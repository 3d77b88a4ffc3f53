"""Names that differ, where a file may hold equal ones."""

from __future__ import annotations


def distinct(names: list[str]) -> tuple[str, ...]:
    """Make names differ by numbers behind the later ones.

    Parameters
    ----------
    names : list of str
        Names, maybe equal.

    Returns
    -------
    tuple of str
        Distinct names.

    Examples
    --------
    >>> distinct(["a", "b", "a"])
    ('a', 'b', 'a_2')
    """
    taken, seen, result = set(names), set[str](), list[str]()
    for name in names:
        new, k = name, 2
        while new in seen or (new != name and new in taken):
            new, k = f"{name}_{k}", k + 1
        seen.add(new)
        result.append(new)
    return tuple(result)
