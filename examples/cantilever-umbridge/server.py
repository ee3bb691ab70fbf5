"""A cantilever of rectangular section as a UM-Bridge model: deflection and bending stress under a load at its end.

    python3 server.py [PORT]

Needs `pip install umbridge`.
"""

import sys

import umbridge


class Cantilever(umbridge.Model):
    def __init__(self):
        super().__init__("cantilever")

    def get_input_sizes(self, config):
        return [2, 3]

    def get_output_sizes(self, config):
        return [2]

    def __call__(self, parameters, config):
        (F, E), (L, b, h) = parameters
        if min(E, L, b, h) <= 0:
            raise ValueError("a length or modulus is not positive")
        return [[4 * F * L**3 / (E * b * h**3), 6 * F * L / (b * h**2)]]

    def gradient(self, out_wrt, in_wrt, parameters, sens, config):
        (F, E), (L, b, h) = parameters
        ((deflection, stress),) = self(parameters, config)
        # Both are products of powers: the derivative is exponent times value over the input.
        powers = [[(1, 1), (-1, 0)], [(3, 1), (-1, -1), (-3, -2)]][in_wrt]
        return [
            (sens[0] * a * deflection + sens[1] * c * stress) / value
            for (a, c), value in zip(powers, parameters[in_wrt])
        ]

    def supports_evaluate(self):
        return True

    def supports_gradient(self):
        return True


if __name__ == "__main__":
    umbridge.serve_models([Cantilever()], int(sys.argv[1]) if len(sys.argv) > 1 else 4242, max_workers=4)
