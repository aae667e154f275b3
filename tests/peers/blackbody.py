"""Color of a blackbody at luminance 1, linear Rec.709, channels below 0 cut off: Planck's law under the CIE 1931
observer, whose table Mitsuba brings."""
import functools

import numpy as np

WAVELENGTHS = np.arange(360.0, 831.0)  # nm
KELVIN = np.geomspace(300, 10000, 512)
XYZ_TO_RGB = np.array([[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560],
                       [0.0556434, -0.2040259, 1.0572252]])


@functools.cache
def table():
    import mitsuba as mi
    mi.set_variant("scalar_rgb")
    observer = np.array([np.array(mi.cie1931_xyz(wavelength)) for wavelength in WAVELENGTHS])
    exponent = 1.438776877e7 / (WAVELENGTHS * KELVIN[:, None])  # nm K
    planck = WAVELENGTHS ** -5 * np.exp(exponent.min(1, keepdims=True) - exponent) / -np.expm1(-exponent)
    xyz = planck @ observer
    # 2 h c² = 1.191043e29 W nm⁴/(m² sr), seen at 683 lm/W; the exponent that was taken out is put back.
    nits = 683 * 1.191042972e29 * xyz[:, 1] * np.exp(-exponent.min(1)) * 1e-9
    return np.maximum(xyz / xyz[:, 1:2] @ XYZ_TO_RGB.T, 0), nits


def color(kelvin):
    return np.stack([np.interp(kelvin, KELVIN, column) for column in table()[0].T], -1)


def radiance(kelvin):
    """Of Planck's law, nits."""
    return color(kelvin) * np.interp(kelvin, KELVIN, table()[1])[..., None]
