"""Airspeeds in the standard atmosphere (ISO 2533)."""

TROPOSPHERE_M = 11_000.0  # how high the formula holds


def true_airspeed(calibrated, alt_m):
    """From that of VFR_HUD, which is as if the air were as dense as at the sea, and the height above it. None where the
    height is not known. For speeds at which air is not compressed."""
    if alt_m is None or alt_m > TROPOSPHERE_M:
        return None
    return calibrated * (1.0 - 2.25577e-5 * alt_m) ** -2.12794
