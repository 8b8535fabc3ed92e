"""Immutable records: frozen dataclasses whose methods are shared by all classes.

`dataclasses.dataclass` generates and compiles six methods for each class, which takes 0.6 ms. A run imports
two hundred such classes, so that this would take a third of a short run.
"""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any, ClassVar, dataclass_transform

if TYPE_CHECKING:
    from inspect import Signature


class _Signature:
    """The signature of a class, for ``help`` and messages; computed on access."""

    def __get__(self, record: object, cls: type[Frozen]) -> Signature:
        from inspect import Parameter, Signature

        def parameter(name: str) -> Parameter:
            field = cls.__dataclass_fields__[name]
            optional = name in cls._defaults or name in cls._factories
            default = cls._defaults.get(name, ...) if optional else Parameter.empty
            kind = Parameter.KEYWORD_ONLY if field.kw_only else Parameter.POSITIONAL_OR_KEYWORD
            return Parameter(name, kind, default=default, annotation=field.type)

        return Signature([parameter(name) for name in cls._taken])


@dataclass_transform(frozen_default=True, field_specifiers=(dataclasses.field,))
class Frozen:
    """Base class that makes subclasses frozen records, as ``@dataclass(frozen=True)`` does.

    Fields are annotated names, with `dataclasses.field` if needed. `dataclasses.replace`, `fields` and
    ``__post_init__`` work as usual. Records are equal if they have the same class and all compared fields are
    equal. Setting a field raises `dataclasses.FrozenInstanceError`; unknown or missing arguments raise
    TypeError.

    >>> class Spring(Frozen):
    ...     stiffness: float
    ...     preload: float = 0.0
    >>> dataclasses.replace(Spring(2.0), preload=1.0)
    Spring(stiffness=2.0, preload=1.0)
    """

    __signature__: ClassVar[Any] = _Signature()
    __dataclass_fields__: ClassVar[dict[str, dataclasses.Field[Any]]]
    _positional: ClassVar[tuple[str, ...]] = ()  # the fields that are arguments
    _taken: ClassVar[tuple[str, ...]] = ()  # these and the keyword-only fields
    _known: ClassVar[frozenset[str]] = frozenset()  # fields that have a value before `__post_init__`
    _defaults: ClassVar[dict[str, Any]] = {}
    _factories: ClassVar[dict[str, Any]] = {}
    _compared: ClassVar[tuple[str, ...]] = ()
    _shown: ClassVar[tuple[str, ...]] = ()

    def __init_subclass__(cls, **keywords: Any) -> None:
        super().__init_subclass__(**keywords)
        every = _fields_of(cls)
        missing = dataclasses.MISSING
        cls._positional = tuple(one.name for one in every if one.init and not one.kw_only)
        cls._taken = cls._positional + tuple(one.name for one in every if one.init and one.kw_only)
        cls._defaults = {one.name: one.default for one in every if one.default is not missing}
        cls._factories = {
            one.name: one.default_factory for one in every if one.default_factory is not missing
        }
        cls._known = frozenset((*cls._taken, *cls._defaults, *cls._factories))
        cls._compared = tuple(one.name for one in every if one.compare)
        cls._shown = tuple(one.name for one in every if one.repr)

    def __init__(self, *values: Any, **named: Any) -> None:
        own, count = self.__dict__, len(values)
        own.update(self._defaults)
        own.update(zip(self._positional, values, strict=False))
        own.update(named)
        for name, factory in self._factories.items():
            if name not in own:
                own[name] = factory()
        twice = count and named and not named.keys().isdisjoint(self._positional[:count])
        if twice or count > len(self._positional) or own.keys() != self._known:
            raise self._refused(values, named)
        self.__post_init__()

    def __post_init__(self) -> None:
        """Hook after initialisation; does nothing here."""

    def _refused(self, values: tuple[Any, ...], named: dict[str, Any]) -> TypeError:
        """TypeError for wrong arguments, with the message of Python for a function."""
        try:
            type(self).__signature__.bind(*values, **named)
        except TypeError as error:
            return TypeError(f"{type(self).__name__}: {error}")
        raise AssertionError("arguments that fit")

    def __setattr__(self, name: str, value: Any) -> None:
        raise dataclasses.FrozenInstanceError(f"cannot assign to field {name!r}")

    def __delattr__(self, name: str) -> None:
        raise dataclasses.FrozenInstanceError(f"cannot delete field {name!r}")

    def __eq__(self, other: object) -> bool:
        if other.__class__ is not self.__class__:
            return NotImplemented
        return _values(self, self._compared) == _values(other, self._compared)

    def __hash__(self) -> int:
        return hash(_values(self, self._compared))

    def __repr__(self) -> str:
        shown = ", ".join(f"{name}={getattr(self, name)!r}" for name in self._shown)
        return f"{type(self).__qualname__}({shown})"


def _fields_of(cls: type[Frozen]) -> tuple[dataclasses.Field[Any], ...]:
    """Makes a class a dataclass without methods, and returns its fields.

    `dataclasses` would parse each annotation three times, since a string may not define a field. Placeholder
    annotations avoid this, which halves the time.
    """
    own = cls.__dict__.get("__annotations__", {})  # noqa: RUF063  # inspect would be loaded for it
    cls.__annotations__ = {name: object for name, kind in own.items() if "ClassVar" not in str(kind)}
    every = dataclasses.fields(dataclasses.dataclass(init=False, repr=False, eq=False)(cls))
    cls.__annotations__ = own
    for one in every:
        one.type = own.get(one.name, one.type)
    return every


def _values(record: Any, names: tuple[str, ...]) -> tuple[Any, ...]:
    return tuple(getattr(record, name) for name in names)
