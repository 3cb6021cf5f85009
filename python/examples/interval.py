"""A plot of a distance and its interval while one box slides over another's edge: interval.svg."""
import matplotlib
import numpy as np
import swiftprox

matplotlib.use("Agg")
from matplotlib import pyplot

pair = swiftprox.Pair(swiftprox.Shape.box(1, 1, 1), swiftprox.Shape.box(1, 1, 1))
x = np.linspace(1.5, 3.5, 400)
poses = np.tile(np.eye(4), (len(x), 1, 1))
poses[:, 0, 3], poses[:, 2, 3] = x, 2.5
answers = pair.distances(np.eye(4), poses)
figure, (above, below) = pyplot.subplots(2, sharex=True)
above.plot(x, answers["distance"])
above.set_ylabel("distance")
below.semilogy(x, np.maximum(answers["upper"] - answers["lower"], 1e-18))
below.set(xlabel="x", ylabel="upper - lower")
figure.savefig("interval.svg")
print("widest interval:", (answers["upper"] - answers["lower"]).max())
