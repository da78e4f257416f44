"""pymunk as a forward simulator: forward.engine: rtg.examples.pymunk_engine:Pymunk."""

import numpy as np
import pymunk

import rtg

STEPS, REST = 250, 75  # of a push, and until all have come to rest


class Pymunk:
    def __init__(self, scene: rtg.engines.Scene) -> None:
        speed = scene.stride / scene.push_s
        self.scene = scene
        self.drag = scene.bodies[0].mass * scene.damping * speed

    def push(self, states: np.ndarray, ways: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        ends = np.array([self.end(*push) for push in zip(states, ways, strict=True)])
        return ends, np.isfinite(ends).all((1, 2))

    def end(self, state: np.ndarray, way: np.ndarray) -> np.ndarray:
        space, bodies = pymunk.Space(), []
        space.damping = np.exp(-self.scene.damping)
        space.collision_slop, space.collision_bias = 0.01 * self.scene.size, 1e-9
        for body, (x, y, theta) in zip(self.scene.bodies, state.tolist(), strict=True):
            kind = pymunk.Body.STATIC if body.fixed else pymunk.Body.DYNAMIC
            bodies.append(made := pymunk.Body(body.mass, body.moment, kind))
            made.position, made.angle = (x, y), theta
            space.add(made)
            for part in body.parts:
                at = part.vertices.tolist()
                disc = len(at) == 1 and pymunk.Circle(made, part.radius, at[0])
                space.add(shape := disc or pymunk.Poly(made, at, radius=part.radius))
                shape.friction = np.sqrt(body.friction)  # pymunk takes the product of two
        for joint in self.scene.joints:  # revolute ones; others are left to you
            ends = bodies[joint.parent], bodies[joint.child]
            pin = pymunk.PivotJoint(*ends, joint.on_parent.tolist(), joint.on_child.tolist())
            pin.collide_bodies = False
            space.add(pin, pymunk.RotaryLimitJoint(*ends, joint.lower, joint.upper))
        robot, hand = bodies[0], pymunk.Body(body_type=pymunk.Body.KINEMATIC)
        hand.position, hand.angle = robot.position, robot.angle
        space.add(hand, pull := pymunk.PivotJoint(hand, robot, (0, 0), (0, 0)))
        space.add(turn := pymunk.GearJoint(hand, robot, 0.0, 1.0))
        pull.max_force = self.drag * self.scene.force_factor
        turn.max_force = self.drag * self.scene.torque_factor * self.scene.size
        for steps, velocity in (STEPS, way / self.scene.push_s), (REST, np.zeros(2)):
            hand.position, hand.velocity = robot.position, velocity.tolist()
            for _ in range(steps):
                space.step(self.scene.push_s / STEPS)
        return np.array([[*body.position, body.angle] for body in bodies])
