"""A user's formula cut into tokens that know their place, and the error that names a place."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

LONGEST = 4000  # characters of a formula: more is no strain energy that a person wrote
_LONGEST_NUMBER = 40  # characters of a number
_LARGEST_POWER_OF_TEN = 100  # of a number such as 1e-12: SI values lie far within
_LONGEST_SHOWN = 20  # characters of what an error repeats
_MARKS = ("**", "+", "-", "*", "/", "^", "(", ")")  # the longer ones first


class ExpressionError(ValueError):
    """A formula that cannot be read, and where.

    Attributes:
        line, column: the place, each from 1.
        reason: what stands there and what is allowed, one line.
    """

    def __init__(self, text: str, position: int, reason: str) -> None:
        self.line = text.count("\n", 0, position) + 1
        self.column = position - text.rfind("\n", 0, position)
        self.reason = reason
        super().__init__(f"line {self.line}, column {self.column}: {reason}")


@dataclass(frozen=True)
class Token:
    """One piece of a formula; `kind` is "number", "name", "mark" or "end"."""

    kind: str
    text: str
    position: int  # offset into the formula, from 0


def shown(text: str) -> str:
    """What a user wrote, safe to print: ASCII, one line, cut short."""
    cut = text if len(text) <= _LONGEST_SHOWN else f"{text[:_LONGEST_SHOWN]}..."
    return ascii(cut)


def tokenize(text: str) -> tuple[Token, ...]:
    """Cut a formula into numbers, names and marks, the last token being the end.

    Raises:
        ExpressionError: a character that has no meaning here, a number too long or too large to be one of
            physics, or a formula longer than `LONGEST`.
    """
    if len(text) > LONGEST:
        raise ExpressionError(text, LONGEST, f"the formula has {len(text)} characters, allowed are {LONGEST}")
    return (*_tokens(text), Token("end", "", len(text)))


def _tokens(text: str) -> Iterator[Token]:
    at = 0
    while at < len(text):
        if text[at] in " \t\r\n":
            at += 1
            continue
        token = _token_at(text, at)
        at += len(token.text)
        yield token


def _token_at(text: str, at: int) -> Token:
    character, following = text[at], text[at + 1 : at + 2]
    if _is_digit(character) or (character == "." and _is_digit(following)):
        return _number(text, at)
    if _is_letter(character):
        return Token("name", text[at : _run(text, at, _belongs_to_name)], at)
    for mark in _MARKS:
        if text.startswith(mark, at):
            return Token("mark", mark, at)
    allowed = "allowed are numbers, names of ASCII letters, digits and _, and + - * / ^ ** ( )"
    raise ExpressionError(text, at, f"found {shown(character)}; {allowed}")


def _number(text: str, at: int) -> Token:
    """Digits, with a decimal point and a power of ten where they stand."""
    end = _run(text, at, _is_digit)
    if text[end : end + 1] == ".":
        end = _run(text, end + 1, _is_digit)
    power = _power_of_ten(text, end)
    token = Token("number", text[at : end + len(power)], at)
    if len(token.text) > _LONGEST_NUMBER:
        reason = (
            f"the number {shown(token.text)} has {len(token.text)} characters, allowed are {_LONGEST_NUMBER}"
        )
        raise ExpressionError(text, at, reason)
    if power and abs(int(power[1:])) > _LARGEST_POWER_OF_TEN:
        reason = f"found {shown(token.text)}; allowed are powers of ten up to {_LARGEST_POWER_OF_TEN}"
        raise ExpressionError(text, at, reason)
    return token


def _power_of_ten(text: str, at: int) -> str:
    """`e-12` where that stands at a place, else nothing."""
    if text[at : at + 1] not in ("e", "E"):
        return ""
    digits = at + 2 if text[at + 1 : at + 2] in ("+", "-") else at + 1
    end = _run(text, digits, _is_digit)
    return text[at:end] if end > digits else ""


def _run(text: str, at: int, belongs: Callable[[str], bool]) -> int:
    while at < len(text) and belongs(text[at]):
        at += 1
    return at


def _is_digit(character: str) -> bool:
    return character.isascii() and character.isdigit()


def _is_letter(character: str) -> bool:
    return character.isascii() and character.isalpha()


def _belongs_to_name(character: str) -> bool:
    return character.isascii() and (character.isalnum() or character == "_")
