"""Phase functions as formulas, per steradian: Henyey and Greenstein 1941; Draine 2003, its equation 4."""
import math


def phase(fog, cosine):
    g, alpha = fog.g, fog.alpha
    lobe = (1 - g * g) / (4 * math.pi * (1 + g * g - 2 * g * cosine) ** 1.5)
    return lobe * (1 + alpha * cosine ** 2) / (1 + alpha * (1 + 2 * g * g) / 3)
