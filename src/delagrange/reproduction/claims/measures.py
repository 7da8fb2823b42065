"""What words such as "beating" or "creep" mean here, as numbers.

Each measure states its definition, so that a reader can disagree with it.
"""

from __future__ import annotations

import numpy as np
from scipy.signal import find_peaks

BEATING_DEPTH = 0.5  # of the modulation of what vibrates near the driving frequency; more is a beating, if
BEATING_SHARE = 0.25  # that is at least this much of the whole swing
SMALL_CREEP = 0.01  # share of the largest strain; less is small
MODE_PROMINENCE = 0.1  # of a response curve's peak, relative to the range of the curve
LINE_HEIGHT = 0.1  # of a spectral line, relative to the highest


def envelope_near(values: np.ndarray, spacing: float, frequency: float) -> np.ndarray:
    """Envelope of what a history (n_samples,), sampled every `spacing` [s], has within 20 % of a frequency [Hz].

    The magnitude of the analytic signal of that band; a twentieth at each end, which the cut spoils, is left out.
    """
    spectrum = np.fft.fft(values - values.mean())
    bins = np.fft.fftfreq(len(values), spacing)
    band = (bins > 0.8 * frequency) & (bins < 1.2 * frequency)
    edge = len(values) // 20
    return np.abs(np.fft.ifft(2 * spectrum * band))[edge:-edge]


def beating(values: np.ndarray, spacing: float, frequency: float) -> tuple[float, float]:
    """Depth of the modulation near a frequency, (high - low) / (high + low), and `high` over half the whole swing.

    High and low are the 95th and 5th percentiles of the envelope.
    """
    low, high = np.percentile(envelope_near(values, spacing, frequency), [5, 95])
    return float((high - low) / (high + low)), float(high / (np.ptp(values) / 2))


def creep_ratio(stretch: np.ndarray, inelastic_stretch: np.ndarray) -> float:
    """Largest inelastic strain over largest strain, both from the first sample."""
    return float(
        np.max(np.abs(inelastic_stretch - inelastic_stretch[0])) / np.max(np.abs(stretch - stretch[0]))
    )


def mode_count(amplitude: np.ndarray) -> int:
    """Peaks of a response curve that stand out by a tenth of its range."""
    reach = np.nanmax(amplitude) - np.nanmin(amplitude)
    peaks, _ = find_peaks(amplitude, prominence=MODE_PROMINENCE * reach)
    return len(peaks)


def spectral_lines(values: np.ndarray, spacing: float) -> np.ndarray:
    """Frequencies [Hz] of the lines, a tenth of the highest or more, of a history sampled every `spacing` [s].

    Hann window, zero-padded eightfold; lines nearer to zero than two resolution widths are left out.
    """
    window = np.hanning(len(values))
    spectrum = np.abs(np.fft.rfft((values - values.mean()) * window, 8 * len(values)))
    frequency = np.fft.rfftfreq(8 * len(values), spacing)
    spectrum[frequency < 2 / (len(values) * spacing)] = 0.0
    lines, _ = find_peaks(spectrum, height=LINE_HEIGHT * spectrum.max())
    return frequency[lines]
