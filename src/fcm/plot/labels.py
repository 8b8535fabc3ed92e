"""Names of quantities as a reader knows them: ``contact.shroud.n_0`` is n with the subscript 0."""

from __future__ import annotations

from collections.abc import Mapping

_GREEK = {"mu", "omega", "zeta", "phi", "theta"}


def symbol(name: str) -> str:
    """The mathematical symbol of a parameter of the scene, without the dollar signs.

    >>> symbol("contact.shroud.n_0"), symbol("contact.tip.mu"), symbol("force.0.amplitude")
    ('n_{0}', '\\\\mu', '\\\\mathrm{amplitude}')
    """
    head, _, index = name.rpartition(".")[2].partition("_")
    if head in _GREEK:
        head = f"\\{head}"
    elif len(head) > 1:
        return f"\\mathrm{{{' '.join(filter(None, (head, index)))}}}".replace("_", "\\_").replace(" ", "\\ ")
    return f"{head}_{{{index}}}" if index else head


def number(value: float) -> str:
    """A short number with a true minus sign."""
    return f"{value:.4g}".replace("-", "−")


def curve_label(parameters: Mapping[str, float], named: bool = True) -> str:
    """``n_0 = 5, mu = 0.4`` in mathematical type; without names only the values."""
    if not named:
        return ", ".join(number(value) for value in parameters.values())
    return ", ".join(f"${symbol(name)}$ = {number(value)}" for name, value in parameters.items())


def frequency_label(unit: str) -> str:
    return "Frequency $f$ (Hz)" if unit.lower() == "hz" else f"Frequency $\\omega$ ({unit})"
