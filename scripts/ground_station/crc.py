"""The checksum of MAVLink."""


def crc(data):
    """CRC-16/MCRF4XX."""
    value = 0xFFFF
    for byte in data:
        byte ^= value & 0xFF
        byte ^= byte << 4 & 0xFF
        value = value >> 8 ^ byte << 8 ^ byte << 3 ^ byte >> 4
    return value & 0xFFFF
