"""Average path length similarity (APLS) of two road networks that are given as masks of pixels.

A. Van Etten, D. Lindenbaum, T. Bacastow: SpaceNet: A Remote Sensing Dataset and Challenge Series, arXiv 1807.01232.
A path of one network is looked up in the other: C = 1 - mean of min(1, |L - L'| / L) over all pairs of control points,
where points without a partner within the tolerance, and broken paths, count 1. The figure is the harmonic mean of both
directions. Control points are ends, junctions and a point every 50 m.
"""
import heapq
import math
from dataclasses import dataclass

import cv2
import numpy as np

CONTROL_M = 50.0
SHORTEST_PATH_M = 10.0
SHORTEST_SPUR_M = 10.0
AROUND = [(r, c) for r in (-1, 0, 1) for c in (-1, 0, 1) if r or c]


def skeleton(mask):
    """Lines of one pixel along the middle of what is set, without the spurs that ragged edges give; bool."""
    padded = cv2.copyMakeBorder(mask.astype(np.uint8) * 255, 1, 1, 1, 1, cv2.BORDER_CONSTANT, value=0)
    return cv2.ximgproc.thinning(padded)[1:-1, 1:-1] > 0


@dataclass
class Edge:
    ends: tuple
    pixels: list  # from one end to the other, both included
    along: np.ndarray  # metres from the first pixel

    @property
    def length(self):
        return float(self.along[-1])


class Roads:
    """A graph: junctions, ends and (on rings) one point are nodes; what lies between them is edges."""

    def __init__(self, mask, pixel_m):
        self.pixel_m = pixel_m
        lines = skeleton(mask)
        edges = trace(lines, pixel_m)
        spurs = [e for e in edges if e.length < SHORTEST_SPUR_M and dangling(e, edges)]
        if spurs:
            for spur in spurs:
                for pixel in spur.pixels[1:-1] + [p for p in spur.ends if degree(p, edges) == 1]:
                    lines[pixel] = False
            edges = trace(lines, pixel_m)
        self.edges = edges
        self.nodes = {node: number for number, node in enumerate(sorted({p for e in edges for p in e.ends}))}
        self.places = {pixel: (number, metres) for number, e in enumerate(edges) for pixel, metres in zip(e.pixels, e.along)}
        self.pixels = np.array(list(self.places), np.float32).reshape(-1, 2)
        self.between = self.distances()

    def distances(self):
        """Metres between all nodes by the shortest way."""
        neighbours = [[] for _ in self.nodes]
        for edge in self.edges:
            one, other = (self.nodes[p] for p in edge.ends)
            neighbours[one].append((other, edge.length))
            neighbours[other].append((one, edge.length))
        return np.array([shortest(neighbours, start) for start in range(len(neighbours))]).reshape(2 * [len(neighbours)])

    def control_points(self):
        points = set(self.nodes)
        for edge in self.edges:
            parts = math.ceil(edge.length / CONTROL_M)
            points |= {edge.pixels[int(np.searchsorted(edge.along, edge.length * i / parts))] for i in range(1, parts)}
        return sorted(points)

    def nearest(self, points, tolerance_m):
        """For each point the pixel of this network within the tolerance, or None."""
        if not len(self.pixels):
            return [None] * len(points)
        found = []
        for point in points:
            squares = ((self.pixels - np.array(point, np.float32)) ** 2).sum(1)
            best = int(squares.argmin())
            near = math.sqrt(float(squares[best])) * self.pixel_m <= tolerance_m
            found.append(tuple(int(v) for v in self.pixels[best]) if near else None)
        return found

    def lengths(self, points):
        """Metres between all of the pixels of this network by the shortest way; infinite where there is none."""
        edge = np.array([self.places[p][0] for p in points])
        ends = np.array([[self.nodes[q] for q in self.edges[e].ends] for e in edge])
        first = np.array([self.places[p][1] for p in points])
        rest = np.stack([first, np.array([self.edges[e].length for e in edge]) - first], 1)
        best = np.full((len(points),) * 2, np.inf)
        for a in range(2):
            for b in range(2):
                way = self.between[np.ix_(ends[:, a], ends[:, b])] + rest[:, a][:, None] + rest[:, b][None]
                best = np.minimum(best, way)
        same = edge[:, None] == edge[None]
        return np.where(same, np.minimum(best, np.abs(first[:, None] - first[None])), best)


def shortest(neighbours, start):
    metres = [math.inf] * len(neighbours)
    metres[start] = 0.0
    heap = [(0.0, start)]
    while heap:
        so_far, node = heapq.heappop(heap)
        if so_far > metres[node]:
            continue
        for other, length in neighbours[node]:
            if so_far + length < metres[other]:
                metres[other] = so_far + length
                heapq.heappush(heap, (metres[other], other))
    return metres


def trace(lines, pixel_m):
    """The edges of a skeleton."""
    there = {(int(r), int(c)) for r, c in np.argwhere(lines)}
    links = {p: adjacent(p, there) for p in there}
    nodes = {p for p in there if len(links[p]) != 2}
    edges, used = [], set()

    def follow(node, step):
        pixels = [node, step]
        while pixels[-1] not in nodes and pixels[-1] != node:
            ahead = [p for p in links[pixels[-1]] if p != pixels[-2]]
            pixels.append(ahead[0])
        used.update({(pixels[0], pixels[1]), (pixels[-1], pixels[-2])})
        steps = [math.dist(a, b) * pixel_m for a, b in zip(pixels, pixels[1:])]
        edges.append(Edge((pixels[0], pixels[-1]), pixels, np.concatenate([[0.0], np.cumsum(steps)])))

    for node in sorted(nodes):
        for step in links[node]:
            if (node, step) not in used:
                follow(node, step)
    rings = there - nodes - {p for e in edges for p in e.pixels}
    while rings:
        start = min(rings)
        follow(start, links[start][0])
        rings -= set(edges[-1].pixels)
    return edges


def adjacent(pixel, there):
    """Neighbours; a diagonal one only where no straight one leads to it already."""
    near = [(pixel[0] + r, pixel[1] + c) for r, c in AROUND if (pixel[0] + r, pixel[1] + c) in there]
    straight = [p for p in near if p[0] == pixel[0] or p[1] == pixel[1]]
    return [p for p in near if p in straight or not any(math.dist(p, s) == 1.0 for s in straight)]


def degree(node, edges):
    return sum((e.ends[0] == node) + (e.ends[1] == node) for e in edges)


def dangling(edge, edges):
    """Only one of its ends goes on: a piece that stands alone is none."""
    return sorted(min(degree(p, edges), 2) for p in edge.ends) == [1, 2]


def one_way(source, other, tolerance_m):
    """Similarity of the paths of `source` as they are in `other`, or None where source has no path."""
    points = source.control_points()
    if len(points) < 2:
        return None
    ours = source.lengths(points)
    partners = other.nearest(points, tolerance_m)
    theirs = np.full(ours.shape, np.inf)
    matched = np.array([i for i, p in enumerate(partners) if p is not None], int)
    if len(matched):
        theirs[np.ix_(matched, matched)] = other.lengths([partners[i] for i in matched])
    asked = np.isfinite(ours) & (ours >= SHORTEST_PATH_M) & np.triu(np.ones(ours.shape, bool), 1)
    if not asked.any():
        return None
    return float(1.0 - np.minimum(1.0, np.abs(theirs[asked] - ours[asked]) / ours[asked]).mean())


def similarity(truth, proposal, pixel_m, tolerance_m=4.0):
    """APLS of two masks of one shape, 0 to 1; None where the truth has no road to measure."""
    ours, theirs = Roads(truth, pixel_m), Roads(proposal, pixel_m)
    found = one_way(ours, theirs, tolerance_m)
    if found is None:
        return None
    right = one_way(theirs, ours, tolerance_m) or 0.0
    return 2 * found * right / (found + right) if found + right > 0 else 0.0
