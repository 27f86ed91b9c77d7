#!/usr/bin/env python3
"""Writes dcnn_small.json: two small DCNNs computed scalar by scalar, independently of the C++ code.

Standard library only: a scalar reverse-mode derivative, loops for layers, Adam as in Kingma and Ba 2015.
Run: python3 tests/reference/make_dcnn_reference.py
"""
import json
import math
import pathlib
import random

N, H, W, FILTERS, OUTPUTS, EPS, RATE, L2 = 4, 4, 3, (2, 3), 2, 1e-5, 1e-2, 1e-4


class Scalar:
    def __init__(self, value, parents=()):
        self.value, self.parents, self.gradient = value, parents, 0.0

    def __add__(self, other):
        other = other if isinstance(other, Scalar) else Scalar(other)
        return Scalar(self.value + other.value, ((self, 1.0), (other, 1.0)))

    def __mul__(self, other):
        other = other if isinstance(other, Scalar) else Scalar(other)
        return Scalar(self.value * other.value, ((self, other.value), (other, self.value)))

    def __sub__(self, other):
        return self + other * -1.0

    def power(self, p):
        return Scalar(self.value**p, ((self, p * self.value ** (p - 1)),))

    def relu(self):
        return Scalar(max(self.value, 0.0), ((self, 1.0 if self.value > 0 else 0.0),))

    def backward(self):
        order, seen, stack = [], set(), [(self, False)]
        while stack:
            node, done = stack.pop()
            if done:
                order.append(node)
            elif id(node) not in seen:
                seen.add(id(node))
                stack.append((node, True))
                stack.extend((parent, False) for parent, _ in node.parents)
        self.gradient = 1.0
        for node in reversed(order):
            for parent, slope in node.parents:
                parent.gradient += slope * node.gradient


def total(values):
    result = Scalar(0.0)
    for value in values:
        result = result + value
    return result


def convolution(image, weight, bias, padding):
    """image[y][x][c]; weight[ky][kx][c][f]; `same` lacks its neighbours below and to the right."""
    h, w = len(image), len(image[0])
    rows, columns = (h, w) if padding == "same" else (h - 1, w - 1)
    return [[[total(image[y + j][x + i][c] * weight[j][i][c][f]
                    for j in range(2) for i in range(2) if y + j < h and x + i < w
                    for c in range(len(image[0][0]))) + bias[f]
              for f in range(len(bias))] for x in range(columns)] for y in range(rows)]


def batch_norm(images, gamma, beta):
    for c in range(len(gamma)):
        values = [pixel[c] for image in images for row in image for pixel in row]
        mean = total(values) * (1 / len(values))
        variance = total((v - mean).power(2) for v in values) * (1 / len(values))
        scale = (variance + EPS).power(-0.5) * gamma[c]
        for image in images:
            for row in image:
                for pixel in row:
                    pixel[c] = (pixel[c] - mean) * scale + beta[c]


def loss_and_outputs(params, inputs, targets, padding):
    images = [[[[Scalar(v) for v in pixel] for pixel in row] for row in image] for image in inputs]
    for k in range(2):
        weight, bias, gamma, beta = params[4 * k:4 * k + 4]
        images = [convolution(image, weight, bias, padding) for image in images]
        batch_norm(images, gamma, beta)
        images = [[[[v.relu() for v in pixel] for pixel in row] for row in image] for image in images]
    vectors = [[v for row in image for pixel in row for v in pixel] for image in images]
    weight, bias = params[8:]
    outputs = [[total(a * b for a, b in zip(row, vector)) + bias[o] for o, row in enumerate(weight)]
               for vector in vectors]
    errors = [(y - t).power(2) for ys, ts in zip(outputs, targets) for y, t in zip(ys, ts)]
    return total(errors) * (0.5 / N), outputs


def flat(values):
    return [v for item in values for v in flat(item)] if isinstance(values, list) else [values]


def filled(shape, draw):
    return [filled(shape[1:], draw) for _ in range(shape[0])] if shape else draw()


def reference(padding, rng):
    inputs = filled((N, H, W, 1), lambda: rng.uniform(-1, 1))
    targets = filled((N, OUTPUTS), lambda: rng.uniform(-1, 1))
    shapes, channels = [], 1
    for filters in FILTERS:
        shapes += [(2, 2, channels, filters), (filters,), (filters,), (filters,)]
        channels = filters
    features = channels * (H * W if padding == "same" else (H - 2) * (W - 2))
    shapes += [(OUTPUTS, features), (OUTPUTS,)]
    params = [filled(shape, lambda: Scalar(rng.uniform(0.2, 0.9) * rng.choice((-1, 1))))
              for shape in shapes]
    result = {"input": flat(inputs), "target": flat(targets),
              "params0": [[p.value for p in flat(tensor)] for tensor in params]}
    first = [[0.0] * len(flat(tensor)) for tensor in params]
    second = [[0.0] * len(flat(tensor)) for tensor in params]
    for step in range(1, 4):
        for p in flat(params):
            p.gradient = 0.0
        loss, outputs = loss_and_outputs(params, inputs, targets, padding)
        loss.backward()
        if step == 1:
            result["outputs0"] = [y.value for y in flat(outputs)]
            result["loss0"] = loss.value
            result["gradients0"] = [[p.gradient for p in flat(tensor)] for tensor in params]
        for k, tensor in enumerate(params):
            for i, p in enumerate(flat(tensor)):
                decayed = k not in (1, 5, 9)  # not the biases of convolutions and the linear layer
                g = p.gradient + (L2 * p.value if decayed else 0.0)
                first[k][i] = 0.9 * first[k][i] + 0.1 * g
                second[k][i] = 0.999 * second[k][i] + 0.001 * g * g
                m, v = first[k][i] / (1 - 0.9**step), second[k][i] / (1 - 0.999**step)
                p.value -= RATE * m / (math.sqrt(v) + 1e-8)
    result["params3"] = [[p.value for p in flat(tensor)] for tensor in params]
    return result


if __name__ == "__main__":
    generator = random.Random(20)
    document = {padding: reference(padding, generator) for padding in ("same", "valid")}
    path = pathlib.Path(__file__).parent / "dcnn_small.json"
    path.write_text(json.dumps(document, indent=0) + "\n", encoding="utf-8")
