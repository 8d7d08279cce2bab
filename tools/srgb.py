# SPDX-License-Identifier: Apache-2.0
"""The sRGB curve [IEC 61966-2-1], for NumPy arrays of values from 0 on. Nothing is clipped. Needs NumPy."""
import numpy as np


def linear_from_srgb(srgb):
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def srgb_from_linear(linear):
    return np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055)
