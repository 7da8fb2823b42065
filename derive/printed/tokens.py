"""LaTeX cut into tokens that know their place, and the error that names a place."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

_SPACING = frozenset(
    (
        r"\\", r"\,", r"\;", r"\:", r"\!", r"\ ", r"\>", r"\quad", r"\qquad", r"\displaystyle", r"\nonumber",
        r"\notag", r"\big", r"\Big", r"\bigg", r"\Bigg", r"\bigl", r"\bigr", r"\Bigl", r"\Bigr",
        r"\biggl", r"\biggr", r"\Biggl", r"\Biggr",
    )
)  # fmt: skip
_SPACE_CHARACTERS = frozenset("~&")


class Span(NamedTuple):
    """A piece of the source: `latex[start:end]`."""

    start: int
    end: int

    def to(self, other: Span) -> Span:
        """From the start of this one to the end of the other."""
        return Span(self.start, other.end)


class LatexError(ValueError):
    """An equation that the reader does not understand, and where.

    Attributes:
        equation: number of the equation.
        position: offset into the source, from 0.
        line, column: the same place, each from 1.
        found: the text that stands there.
        expected: what would have been understood.
    """

    def __init__(self, source: Source, position: int, found: str, expected: str) -> None:
        before = source.latex[:position]
        self.equation = source.number
        self.position = position
        self.line = before.count("\n") + 1
        self.column = position - (before.rfind("\n") + 1) + 1
        self.found = found
        self.expected = expected
        place = f"Eq. ({self.equation}), line {self.line}, column {self.column}"
        super().__init__(f"{place}: found '{' '.join(found.split())}', expected {expected}")


@dataclass(frozen=True)
class Source:
    """The LaTeX of an equation and the number under which errors name it."""

    number: str
    latex: str

    def error(self, span: Span, expected: str) -> LatexError:
        """The error for what stands at `span`."""
        found = self.latex[span.start : span.end] or "the end"
        return LatexError(self, span.start, found, expected)


@dataclass(frozen=True)
class Token:
    """One piece of LaTeX; `kind` is "number", "letter", "command", "mark" or "end"."""

    kind: str
    text: str
    span: Span


def tokenize(source: Source) -> tuple[Token, ...]:
    """Cut the source into tokens, spacing dropped, the last token being the end.

    Several `$...$` or `$$...$$` blocks are joined; without any, all of the source is read.

    Raises:
        LatexError: a `$` has no partner, or text stands outside of the blocks.
    """
    end = len(source.latex)
    found = [token for block in _math_blocks(source) for token in _tokens_in(source.latex, block)]
    return (*found, Token("end", "", Span(end, end)))


def _math_blocks(source: Source) -> Iterator[Span]:
    if "$" not in source.latex:
        yield Span(0, len(source.latex))
        return
    at = 0
    while (opening := source.latex.find("$", at)) >= 0:
        _refuse_text(source, Span(at, opening))
        mark = "$$" if source.latex.startswith("$$", opening) else "$"
        start = opening + len(mark)
        end = source.latex.find(mark, start)
        if end < 0:
            raise source.error(Span(opening, start), f"a closing {mark}")
        yield Span(start, end)
        at = end + len(mark)
    _refuse_text(source, Span(at, len(source.latex)))


def _refuse_text(source: Source, outside: Span) -> None:
    text = source.latex[outside.start : outside.end]
    if text.strip():
        start = outside.start + len(text) - len(text.lstrip())
        raise source.error(Span(start, start + len(text.strip())), "nothing outside of $...$")


def _tokens_in(latex: str, block: Span) -> Iterator[Token]:
    at = block.start
    while at < block.end:
        token = _token_at(latex, at, block.end)
        at = token.span.end
        if not _is_spacing(token.text):
            yield token


def _is_spacing(text: str) -> bool:
    return text.isspace() or text in _SPACING or text in _SPACE_CHARACTERS


def _token_at(latex: str, at: int, limit: int) -> Token:
    character = latex[at]
    if character == "\\":
        end = _command_end(latex, at, limit)
        kind = "command" if latex[end - 1].isalpha() else "mark"
    elif _is_digit(character):
        end, kind = _number_end(latex, at, limit), "number"
    else:
        end, kind = at + 1, "letter" if character.isalpha() else "mark"
    return Token(kind, latex[at:end], Span(at, end))


def _is_digit(character: str) -> bool:
    return character.isascii() and character.isdigit()


def _command_end(latex: str, at: int, limit: int) -> int:
    end = _run(latex, at + 1, limit, lambda character: character.isascii() and character.isalpha())
    return min(max(end, at + 2), limit)


def _number_end(latex: str, at: int, limit: int) -> int:
    """A full stop belongs to the number only when a digit follows: `= 0.` ends a sentence."""
    end = _run(latex, at, limit, _is_digit)
    decimals = _run(latex, end + 1, limit, _is_digit)
    return decimals if end < limit and latex[end] == "." and decimals > end + 1 else end


def _run(latex: str, at: int, limit: int, belongs) -> int:
    while at < limit and belongs(latex[at]):
        at += 1
    return at
