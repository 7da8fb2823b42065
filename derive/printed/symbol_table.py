"""Which printed symbol stands for which quantity: `\\lambda_{\\rm EB}` is the in-plane stretch."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from types import MappingProxyType

from delagrange.derive.notation.symbols import Quantity, TimeDependent
from delagrange.derive.printed.tokens import Source, Span, Token, tokenize

DOTS: Mapping[str, int] = MappingProxyType({r"\dot": 1, r"\ddot": 2})
FONTS = frozenset(
    (
        r"\mathrm", r"\rm", r"\text", r"\textrm", r"\mathit", r"\textit", r"\it", r"\mathbf", r"\textbf",
        r"\bf", r"\mathsf", r"\operatorname",
    )
)  # fmt: skip
GREEK = frozenset(
    "\\" + letter
    for letter in (
        "alpha", "beta", "gamma", "delta", "epsilon", "varepsilon", "zeta", "eta", "theta",
        "vartheta", "iota", "kappa", "lambda", "mu", "nu", "xi", "pi", "rho", "varrho", "sigma",
        "tau", "upsilon", "phi", "varphi", "chi", "psi", "omega", "Gamma", "Delta", "Theta",
        "Lambda", "Xi", "Pi", "Sigma", "Upsilon", "Phi", "Psi", "Omega", "ell",
    )
)  # fmt: skip


@dataclass(frozen=True)
class Name:
    """A printed symbol without its typesetting.

    `\\dot{\\lambda}_{\\text{UA}1}` is the letter `\\lambda` with the subscript "UA1" and one dot.
    """

    letter: str  # "P" or "\\lambda"
    subscript: str = ""  # "UA1"
    label: str = ""  # a superscript that is part of the name, "\\alpha"
    dots: int = 0  # order of the rate of change

    def __str__(self) -> str:
        accent = {count: command for command, count in DOTS.items()}
        head = f"{accent[self.dots]}{{{self.letter}}}" if self.dots else self.letter
        return head + _script("_", self.subscript) + _script("^", self.label)


def _script(mark: str, text: str) -> str:
    return f"{mark}{{{text}}}" if text else ""


@dataclass(frozen=True)
class SymbolTable:
    """The symbols of one source. Build it with `SymbolTable.of`."""

    entries: Mapping[Name, Quantity]
    partners: tuple[tuple[Name, Name], ...] = field(default=())

    @classmethod
    def of(
        cls, entries: Mapping[str, Quantity | TimeDependent], *, partners: tuple[tuple[str, str], ...] = ()
    ) -> SymbolTable:
        """A table from LaTeX keys; a `TimeDependent` also gives `\\dot`, `\\ddot` and d/dt of its key.

        Args:
            entries: what each key stands for.
            partners: pairs of keys that a misprint could confuse, beside those that follow from
                their indices (`\\lambda_1` and `\\lambda_2`, `\\mu^\\alpha` and `\\mu^\\beta`).

        Raises:
            LatexError: a key is not one symbol.
            ValueError: two keys are the same symbol, or a partner is not in the table.
        """
        named: dict[Name, Quantity] = {}
        for key, meaning in entries.items():
            for name, quantity in with_rates(name_of(key), meaning):
                if name in named:
                    raise ValueError(f"symbol {name} stands twice in the symbol table")
                named[name] = quantity
        pairs = tuple((name_of(first), name_of(second)) for first, second in partners)
        for name in (name for pair in pairs for name in pair if name not in named):
            raise ValueError(f"symbol {name} has a partner and is not in the symbol table")
        return cls(MappingProxyType(named), pairs)

    def __contains__(self, name: Name) -> bool:
        return name in self.entries

    def __getitem__(self, name: Name) -> Quantity:
        return self.entries[name]

    def nearest(self, name: Name) -> tuple[str, ...]:
        """The keys that look most like a name, or all keys without dots when none does."""
        keys = {str(known): known for known in self.entries}
        near = get_close_matches(str(name), list(keys), n=3, cutoff=0.5)
        return tuple(near) or tuple(key for key, known in keys.items() if not known.dots)


def with_rates(name: Name, meaning: Quantity | TimeDependent) -> tuple[tuple[Name, Quantity], ...]:
    """A name with what it stands for; of what moves, its rates under dots as well."""
    if isinstance(meaning, Quantity):
        return ((name, meaning),)
    return tuple((replace(name, dots=dots), quantity) for dots, quantity in enumerate(meaning.parts))


def name_of(key: str) -> Name:
    """The name that a LaTeX key such as `\\mu^{\\alpha}` or `\\xi_{\\rm EB}` writes.

    Raises:
        LatexError: the key is not one symbol.
    """
    source = Source("symbol table", key)
    name, end, superscript = read_symbol(source, tokenize(source), 0)
    if superscript is not None:
        tokens = tokenize(source)
        name = replace(name, label=label_at(tokens, superscript))
        if not name.label:
            raise source.error(tokens[superscript].span, "a label of letters and digits")
    if (rest := tokenize(source)[end]).kind != "end":
        raise source.error(rest.span, "one symbol")
    return name


def read_symbol(source: Source, tokens: tuple[Token, ...], at: int) -> tuple[Name, int, int | None]:
    """Read a symbol with its dots and scripts.

    Returns:
        The name without a superscript, the index after all of it, and the index of what follows
        its `^` (None without one): only the symbol table can tell a label from an exponent.

    Raises:
        LatexError: no symbol stands there, or a script is not understood.
    """
    dots = DOTS.get(tokens[at].text, 0)
    if not dots:
        return _read_scripts(source, tokens, at + 1, Name(_letter(source, tokens[at])))
    braced = tokens[at + 1].text == "{"
    inner = at + 2 if braced else at + 1
    name, end = _read_subscript(source, tokens, inner + 1, Name(_letter(source, tokens[inner]), dots=dots))
    if braced and tokens[end].text != "}":
        raise source.error(tokens[end].span, "}")
    return _read_scripts(source, tokens, end + 1 if braced else end, name)


def _letter(source: Source, token: Token) -> str:
    if token.kind != "letter" and token.text not in GREEK:
        raise source.error(token.span, "a symbol")
    return token.text


def _read_subscript(source: Source, tokens: tuple[Token, ...], at: int, name: Name) -> tuple[Name, int]:
    if tokens[at].text != "_":
        return name, at
    if name.subscript:
        raise source.error(tokens[at].span, "no second subscript")
    text = label_at(tokens, at + 1)
    if not text:
        raise source.error(tokens[at + 1].span, "a subscript of letters and digits")
    return replace(name, subscript=text), script_end(source, tokens, at + 1)


def _read_scripts(
    source: Source, tokens: tuple[Token, ...], at: int, name: Name
) -> tuple[Name, int, int | None]:
    superscript: int | None = None
    while tokens[at].text in ("_", "^"):
        if tokens[at].text == "_":
            name, at = _read_subscript(source, tokens, at, name)
            continue
        if superscript is not None:
            raise source.error(tokens[at].span, "no second superscript")
        superscript = at + 1
        at = script_end(source, tokens, superscript)
    return name, at, superscript


def script_end(source: Source, tokens: tuple[Token, ...], at: int) -> int:
    """The index after the script that starts at index `at`: one letter or digit, or braces.

    Raises:
        LatexError: the braces do not close, or no script stands there.
    """
    first = tokens[at]
    if first.text != "{":
        if not _is_script_character(first):
            raise source.error(first.span, "one letter or digit, or braces")
        return at + 1
    depth = 0
    for index in range(at, len(tokens)):
        depth += {"{": 1, "}": -1}.get(tokens[index].text, 0)
        if depth == 0:
            return index + 1
    raise source.error(first.span, "braces that close")


def _is_script_character(token: Token) -> bool:
    if token.kind == "number":
        return len(token.text) == 1
    return token.kind == "letter" or token.text in GREEK


def label_at(tokens: tuple[Token, ...], at: int) -> str:
    """The text of a script of letters, digits and commas alone, typesetting dropped, else ""."""
    if tokens[at].text != "{":
        return tokens[at].text if _is_script_character(tokens[at]) else ""
    text, depth = "", 0
    for token in tokens[at:]:
        depth += {"{": 1, "}": -1}.get(token.text, 0)
        if depth == 0:
            return text
        if token.kind in ("number", "letter") or token.text in GREEK or token.text == ",":
            # "\alpha x" must not become the command "\alphax"
            text += (" " if _ends_in_command(text) and token.kind == "letter" else "") + token.text
        elif token.text not in FONTS and token.text not in ("{", "}"):
            return ""
    return ""


def _ends_in_command(text: str) -> bool:
    return text.rpartition("\\")[2].isalpha() and "\\" in text


def whole(tokens: tuple[Token, ...], start: int, end: int) -> Span:
    """The piece of the source from token `start` up to, not including, token `end`."""
    return tokens[start].span.to(tokens[end - 1].span)
