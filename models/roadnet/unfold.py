"""A network that can learn on from an exported ONNX file, in which each normalisation is folded into its convolution."""
import cv2
import torch
from torch import nn

from .network import SMALL, RoadNet


def convolutions(network):
    """(convolution, the normalisation after it or None), in the order of their use."""
    used, after = [], {}
    watches = [module.register_forward_hook(lambda conv, *_: used.append(conv)) for module in network.modules()
               if isinstance(module, nn.Conv2d)]
    for module in network.modules():
        if isinstance(module, nn.Sequential):
            children = list(module)
            after.update((a, b) for a, b in zip(children, children[1:]) if isinstance(b, nn.BatchNorm2d))
    with torch.no_grad():
        network(torch.zeros(1, 3, 64, 64))
    for watch in watches:
        watch.remove()
    return [(conv, after.get(conv)) for conv in used]


def weights_of(path):
    """Weights and bias of each convolution of an ONNX file, in the order of their use."""
    net = cv2.dnn.readNetFromONNX(str(path))
    layers = [net.getLayer(net.getLayerId(name)) for name in net.getLayerNames()]
    return [[torch.from_numpy(blob.copy()) for blob in layer.blobs] for layer in layers if layer.type == "Convolution"]


def read_onnx(path):
    """RoadNet in evaluation mode that answers as the file does."""
    weights = weights_of(path)
    network = RoadNet([weights[level][0].shape[0] for level in (0, 3, 6, 9)] if len(weights) > 9 else SMALL).eval()
    pairs = convolutions(network)
    if [conv.weight.shape for conv, _ in pairs] != [weight.shape for weight, _ in weights]:
        raise SystemExit(f"{path} is no single network of models/train.py: name one, or a checkpoint")
    for (conv, norm), (weight, bias) in zip(pairs, weights):
        conv.weight.data.copy_(weight)
        if norm is None:
            conv.bias.data.copy_(bias.flatten())
        else:
            norm.running_var.fill_(1 - norm.eps)
            norm.bias.data.copy_(bias.flatten())
    return network


def settle(network, pictures):
    """Gives the normalisations of a network from read_onnx() the statistics of `pictures` (N x 3 x H x W, as the network
    sees them), so that it goes on answering as it does while it learns."""
    measured = {}
    pairs = [(conv, norm) for conv, norm in convolutions(network) if norm is not None]
    watches = [conv.register_forward_hook(lambda conv, _, out: measured.update({conv: (out.mean((0, 2, 3)), out.var((0, 2, 3)))}))
               for conv, _ in pairs]
    with torch.no_grad():
        network(pictures)
    for watch in watches:
        watch.remove()
    for conv, norm in pairs:
        mean, variance = measured[conv]
        scale = norm.weight / (norm.running_var + norm.eps).sqrt()
        norm.bias.data.add_((mean - norm.running_mean) * scale)
        norm.weight.data.copy_(scale * (variance + norm.eps).sqrt())
        norm.running_mean.copy_(mean)
        norm.running_var.copy_(variance)
