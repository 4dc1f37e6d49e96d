"""The numbers that the network sees: the same for each channel, so that grey stays grey."""
MEAN = (113.0, 113.0, 113.0)
STD = (55.0, 55.0, 55.0)


def normalised(image):
    """0 to 255 to about -2 to 2."""
    return (image - MEAN[0]) / STD[0]
