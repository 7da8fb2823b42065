"""Placing a view in a template that decides nothing."""

from __future__ import annotations

from collections.abc import Mapping

import jinja2
import jinja2.meta


def render(template: str, view: Mapping[str, object]) -> str:
    """The text of the template with the view placed in it.

    Raises:
        KeyError: naming the keys of the view that the template does not place, or lacks.
    """
    environment = _environment()
    _check_keys(environment, template, view)
    return environment.get_template(template).render(view)


def _environment() -> jinja2.Environment:
    return jinja2.Environment(
        loader=jinja2.PackageLoader("delagrange.derive.emit", "templates"),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
    )


def _check_keys(environment: jinja2.Environment, template: str, view: Mapping[str, object]) -> None:
    """A key that the template does not place, or lacks, is a slip in one of the two."""
    if unmatched := sorted(_placed(environment, template) ^ set(view)):
        raise KeyError(f"template {template} and its view differ in {', '.join(unmatched)}")


def _placed(environment: jinja2.Environment, template: str) -> set[str]:
    """The keys that a template and those that it imports place."""
    source, _, _ = environment.loader.get_source(environment, template)  # type: ignore[union-attr]
    parsed = environment.parse(source)
    imported = (_placed(environment, name) for name in jinja2.meta.find_referenced_templates(parsed) if name)
    return jinja2.meta.find_undeclared_variables(parsed).union(*imported)
