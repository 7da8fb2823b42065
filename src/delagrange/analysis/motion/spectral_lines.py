"""Spectral lines of an evenly sampled signal, found far more sharply than the width of a bin.

Windowed frequency analysis after Laskar (1993), Physica D 67, 257 (NAFF), with a power of Hann's window; the
lines disturb one another, so that all are fitted together, as Šidlichovský & Nesvorný (1996), Celest. Mech. 65,
137, correct for it. Frequencies here are in bins, that is in units of 1 / duration, unless said otherwise.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb

import numpy as np
from scipy import fft

_POWER = 3  # of Hann's window: side lobes fall with the seventh power of the distance
_HALF_WIDTH = _POWER + 1  # [bins] of the main lobe
_FITTED = _HALF_WIDTH + 2  # [bins] on each side of a line in which it is fitted
_REACH = 150  # [bins] beyond which the side lobes are below rounding
_NEAREST = 2.0  # [bins] between two lines that can be told apart
_AT_ONCE = 12  # lines taken up between two fits
_MANY, _BROAD = 48, 0.05  # with so many lines, this share of the power left is a broad band
_ROUGHLY, _FULLY = 2, 6  # iterations of a fit
_LARGEST_SHIFT = 0.5  # [bins] in an iteration
_APART = 10.0  # [bins] between lines of which one does little where the other stands
_CONVERGED = 1e-10  # [bins]
_NOISE = 1e-14  # of the mean, below which what varies is rounding
_ROUNDING = 1e-12  # of the strongest line, below which a peak may be rounding


@dataclass(frozen=True)
class Lines:
    """A signal as mean and sum of lines, in falling order of amplitude."""

    frequency: np.ndarray  # (n,) [Hz]
    amplitude: np.ndarray  # (n,) of amplitude cos(2 pi frequency t + phase), in the unit of the signal
    accuracy: np.ndarray  # (n,) [Hz], by how much what is left beside a line may shift it
    residue: float  # share of the power of all that varies which the lines leave unexplained
    resolution: float  # [Hz], width of a bin

    @property
    def power_share(self) -> np.ndarray:
        """(n,) share of each line in the power of all lines."""
        power = self.amplitude**2
        return power / np.sum(power) if len(power) else power


def find_lines(signal: np.ndarray, interval: float, residue: float = 1e-9, most: int = 120) -> Lines:
    """The lines of `signal`, (n_samples,), sampled every `interval` [s].

    The strongest are taken first, until what is left has less than `residue` of the power, nothing is left
    that could be a line, or there are `most`.
    """
    spectrum = _Spectrum.of(signal)
    empty = _Model(np.zeros(0), np.zeros(0, dtype=complex), float(spectrum.values[0].real))
    total = _power(spectrum.without(empty))
    if total <= (_NOISE * empty.mean) ** 2:
        return _nothing(len(signal) * interval)
    model = _gathered(spectrum, empty, residue * total, most)
    rest = spectrum.without(model)
    lines, coefficients = model.lines, model.coefficients
    order = np.argsort(-np.abs(coefficients), kind="stable")
    resolution = 1 / (len(signal) * interval)
    return Lines(
        lines[order] * resolution,
        2 * np.abs(coefficients[order]),
        _accuracy(rest, lines[order], coefficients[order]) * resolution,
        min(1.0, _power(rest) / total),
        resolution,
    )


def _nothing(duration: float) -> Lines:
    """Of a signal that does not vary."""
    return Lines(np.zeros(0), np.zeros(0), np.zeros(0), 0.0, 1 / duration)


@dataclass(frozen=True)
class Band:
    """The spectrum in equal parts of the frequency axis: what a broad band shows, and lines do not."""

    frequency: np.ndarray  # (n,) [Hz], middle of each part
    amplitude: np.ndarray  # (n,) highest amplitude in it, in the unit of the signal


def band(signal: np.ndarray, interval: float, parts: int = 1500) -> Band:
    """The spectrum of `signal`, (n_samples,), without its mean, in at most so many parts."""
    spectrum = _Spectrum.of(signal - np.mean(signal))
    heights = np.array_split(2 * np.abs(spectrum.values), min(parts, len(spectrum.values)))
    edges = np.cumsum([0, *map(len, heights)])
    middles = (edges[:-1] + edges[1:] - 1) / 2
    return Band(middles / (len(signal) * interval), np.array([np.max(part) for part in heights]))


@dataclass(frozen=True)
class _Model:
    """Lines and a mean."""

    lines: np.ndarray  # (n,) [bins]
    coefficients: np.ndarray  # (n,) complex, at the middle of the record
    mean: float

    def with_more(self, lines: np.ndarray, rest: np.ndarray, samples: int) -> _Model:
        """The same and new lines, as high as what is left, `rest`, stands in the bins nearest to them."""
        bins = np.rint(lines).astype(int)
        heights = rest[bins] / window_transform(lines - bins, samples)
        return _Model(np.append(self.lines, lines), np.append(self.coefficients, heights), self.mean)


@dataclass(frozen=True)
class _Spectrum:
    """Windowed Fourier coefficients, the time counted from the middle of the record."""

    values: np.ndarray  # (n_bins,) from zero frequency to half the sampling frequency
    samples: int

    @classmethod
    def of(cls, signal: np.ndarray) -> _Spectrum:
        samples = len(signal)
        middle = np.arange(samples) - (samples - 1) / 2
        window = ((1 + np.cos(2 * np.pi * middle / samples)) / 2) ** _POWER
        values = fft.rfft(signal * window) / (samples * comb(2 * _POWER, _POWER) / 4**_POWER)
        turn = np.exp(1j * np.pi * np.arange(len(values)) * (samples - 1) / samples)
        return cls(values * turn, samples)

    def without(self, model: _Model) -> np.ndarray:
        """What the model leaves."""
        rest = self.values.copy()
        fold = 1.0 if self.samples % 2 else -1.0  # of an even number, the middle falls between two samples
        _take(rest, 0.0, model.mean, self.samples)
        for line, coefficient in zip(model.lines, model.coefficients):
            _take(rest, line, coefficient, self.samples)
            _take(rest, -line, np.conj(coefficient), self.samples)
            _take(rest, self.samples - line, fold * np.conj(coefficient), self.samples)
        return rest


def _gathered(spectrum: _Spectrum, model: _Model, power: float, most: int) -> _Model:
    """The model with more lines, as long as more than `power` is left and they lessen it."""
    rest = spectrum.without(model)
    left = total = _power(rest)
    while left > power and len(model.lines) < most:
        if len(model.lines) >= _MANY and left > _BROAD * total:
            return model  # a broad band, of which lines are no picture, however well they fit
        found = _new_lines(rest, model, min(_AT_ONCE, most - len(model.lines)))
        if len(found) == 0:
            break
        candidate = _fit(spectrum, model.with_more(found, rest, spectrum.samples), _ROUGHLY)
        rest = spectrum.without(candidate)
        if not _power(rest) < left:
            break
        model, left = candidate, _power(rest)
    if len(model.lines) == 0:
        return model
    candidate = _fit(spectrum, model, _FULLY)
    return candidate if _power(spectrum.without(candidate)) < left else model


def window_transform(distance: np.ndarray, samples: int) -> np.ndarray:
    """Hann's window to its power, transformed, at `distance` [bins] from its middle; 1 there."""
    return _sum_of_kernels(_kernel, distance, samples)


def window_slope(distance: np.ndarray, samples: int) -> np.ndarray:
    """Derivative of `window_transform` by the distance [1/bin]."""
    return _sum_of_kernels(_kernel_slope, distance, samples)


def _sum_of_kernels(kernel, distance: np.ndarray, samples: int) -> np.ndarray:
    weights = [comb(2 * _POWER, _POWER + j) / comb(2 * _POWER, _POWER) for j in range(-_POWER, _POWER + 1)]
    places = range(-_POWER, _POWER + 1)
    return sum(weight * kernel(distance + place, samples) for weight, place in zip(weights, places))


def _kernel(x: np.ndarray, samples: int) -> np.ndarray:
    """sin(pi x) / (n sin(pi x / n)), Dirichlet's kernel."""
    near = np.abs(x) < 1e-9
    safe = np.where(near, 1.0, x)
    return np.where(near, 1.0, np.sin(np.pi * safe) / (samples * np.sin(np.pi * safe / samples)))


def _kernel_slope(x: np.ndarray, samples: int) -> np.ndarray:
    near = np.abs(x) < 1e-5
    safe = np.where(near, 1.0, x)
    sine = np.sin(np.pi * safe / samples)
    slope = np.cos(np.pi * safe) / sine - np.sin(np.pi * safe) * np.cos(np.pi * safe / samples) / (
        samples * sine**2
    )
    return np.where(near, -(np.pi**2) * x / 3, np.pi * slope / samples)


def _take(spectrum: np.ndarray, line: float, coefficient: complex, samples: int) -> None:
    """Take a line from the bins that it reaches."""
    first = max(0, int(np.floor(line)) - _REACH)
    last = min(len(spectrum), int(np.ceil(line)) + _REACH)
    if first < last:
        bins = np.arange(first, last)
        spectrum[first:last] -= coefficient * window_transform(line - bins, samples)


def _power(spectrum: np.ndarray) -> float:
    return float(np.sum(np.abs(spectrum) ** 2))


def _new_lines(rest: np.ndarray, model: _Model, count: int) -> np.ndarray:
    """At most `count` lines of about equal strength at the highest peaks of what is left."""
    height = np.abs(rest)
    for line in model.lines:
        first = max(0, int(np.ceil(line - _NEAREST)))
        height[first : int(np.floor(line + _NEAREST)) + 1] = 0.0
    height[: int(_NEAREST)] = 0.0
    inner = (height[1:-1] >= height[:-2]) & (height[1:-1] > height[2:])
    peaks = 1 + np.flatnonzero(inner)
    peaks = peaks[height[peaks] > _ROUNDING * np.max(np.abs(model.coefficients), initial=0.0)]
    peaks = peaks[np.argsort(-height[peaks], kind="stable")][: 20 * count]
    chosen: list[int] = []
    for peak in peaks:
        strong = height[peak] > 0.1 * height[peaks[0]]
        if strong and all(abs(peak - other) > 2 * _HALF_WIDTH for other in chosen):
            chosen.append(int(peak))
    return np.array([_between_bins(np.abs(rest), peak) for peak in chosen[:count]])


def _between_bins(height: np.ndarray, peak: int) -> float:
    """Frequency from the two highest bins, exact for a single line in a power p of Hann's window.

    For p = 1: Grandke (1983), IEEE Trans. Instrum. Meas. 32, 350.
    """
    beside = peak + 1 if height[peak + 1] >= height[peak - 1] else peak - 1
    ratio = height[beside] / height[peak]
    return peak + (beside - peak) * ((_POWER + 1) * ratio - _POWER) / (ratio + 1)


def _fit(spectrum: _Spectrum, model: _Model, iterations: int) -> _Model:
    """The lines that fit best in the bins about them: Gauss and Newton, frequencies and amplitudes together.

    Lines far from each other are corrected each by itself, from what all of them together leave.
    """
    for _ in range(iterations):
        rest = spectrum.without(model)
        shifts = np.zeros(len(model.lines))
        coefficients, mean = model.coefficients.copy(), model.mean
        mean += float(rest[0].real) if np.min(model.lines) > _APART else 0.0
        for members in _clusters(model.lines):
            lines = model.lines[members]
            shifts[members], change, offset = _correction(
                rest, lines, model.coefficients[members], spectrum.samples
            )
            coefficients[members] += change
            mean += offset
        lines = np.clip(model.lines + shifts, 0.5, len(rest) - 1.5)
        model = _Model(lines, coefficients, mean)
        if np.max(np.abs(shifts)) < _CONVERGED:
            break
    return model


def _clusters(lines: np.ndarray) -> list[np.ndarray]:
    """Places of lines, together where they are less than `_APART` bins from a neighbour."""
    order = np.argsort(lines, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(lines[order]) > _APART) + 1)


def _correction(
    rest: np.ndarray, lines: np.ndarray, coefficients: np.ndarray, samples: int
) -> tuple[np.ndarray, np.ndarray, float]:
    """Of frequencies [bins], of coefficients and of the mean, by a linear fit to what is left."""
    count = len(lines)
    bins = _bins(lines, len(rest))
    direct = window_transform(lines - bins, samples)
    image = window_transform(-lines - bins, samples)
    unit = coefficients / np.abs(coefficients)
    moving = window_slope(lines - bins, samples) * unit - window_slope(-lines - bins, samples) * np.conj(unit)
    mean = window_transform(-bins, samples) if np.min(lines) <= _APART else np.zeros((len(bins), 0))
    columns = np.hstack([direct + image, 1j * (direct - image), moving, mean])
    solution = np.linalg.lstsq(
        np.vstack([columns.real, columns.imag]),
        np.concatenate([rest[bins[:, 0]].real, rest[bins[:, 0]].imag]),
        rcond=None,
    )[0]
    shift = solution[2 * count : 3 * count] / np.abs(coefficients)
    return (
        np.clip(shift, -_LARGEST_SHIFT, _LARGEST_SHIFT),
        solution[:count] + 1j * solution[count : 2 * count],
        float(np.sum(solution[3 * count :])),
    )


def _bins(lines: np.ndarray, count: int) -> np.ndarray:
    """(n, 1): the bins about the lines, those of the mean too where a line is near."""
    around = (np.rint(lines)[:, None] + np.arange(-_FITTED, _FITTED + 1)).ravel()
    low = np.arange(_FITTED) if np.min(lines) <= _APART else np.zeros(0)
    bins = np.unique(np.concatenate([around, low]))
    return bins[(bins >= 0) & (bins < count)].astype(int)[:, None]


def _accuracy(rest: np.ndarray, lines: np.ndarray, coefficients: np.ndarray) -> np.ndarray:
    """[bins]: the highest of what is left near each line over the line itself."""
    height = np.abs(rest)
    near = [height[max(0, int(line) - 2 * _FITTED) : int(line) + 2 * _FITTED + 2].max() for line in lines]
    return np.array(near) / np.abs(coefficients) if len(lines) else np.zeros(0)
