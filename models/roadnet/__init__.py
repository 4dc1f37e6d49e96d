"""Roadfix's road network: data, augmentation, model, training. The product runs its ONNX export with OpenCV."""
