import swiftprox

pair = swiftprox.Pair(swiftprox.Shape.box(1, 1, 1), swiftprox.Shape.sphere(0.5))
here, there = swiftprox.Pose(), swiftprox.Pose([[1, 0, 0, 4], [0, 1, 0, 0], [0, 0, 1, 0]])
answer = pair.distance(here, there)
pair.verify(here, there, answer)
print(answer.distance, "within", answer.lower, answer.upper)
