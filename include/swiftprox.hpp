/*
 * swiftprox for C++17 and newer: values, ranges and exceptions over the interface of C, and nothing else. All is inline.
 *
 * What a function does, in which frame and unit, and how it fails stands at the function of C of the same name: swiftprox::distance
 * is swiftprox_pair_distance, Scene::set_pose is swiftprox_scene_set_pose. Answers, infos and statistics are the structs of C.
 *
 * Failure. Functions throw swiftprox::Error, which carries the status and the library's message. Each has a twin, try_..., that
 * throws nothing and returns a Result: a status and a value. With -fno-exceptions only these are there.
 *
 * Ownership. Shape is a share: copying one takes a share, and is cheap. Scene and Replay own theirs and can only be moved.
 * Placed, Moving and Question own their poses and motions, and point at shapes: those from temporary shapes do not compile.
 * Ranges that a scene hands out are its own, valid as long as swiftprox.h says for that answer.
 *
 * Configs. Their members begin with the defaults of C. By C++20 others are set by name: scene.query_contact({.max_distance = 0.1}).
 */
#ifndef SWIFTPROX_HPP
#define SWIFTPROX_HPP

#if __cplusplus < 201703L && !(defined(_MSVC_LANG) && _MSVC_LANG >= 201703L)
#error "swiftprox.hpp needs C++17: compile with -std=c++17 or newer"
#endif

#include "swiftprox/batch.hpp"
#include "swiftprox/compound.hpp"
#include "swiftprox/draw.hpp"
#include "swiftprox/gradient.hpp"
#include "swiftprox/ground.hpp"
#include "swiftprox/library.hpp"
#include "swiftprox/listener.hpp"
#include "swiftprox/motion.hpp"
#include "swiftprox/ray.hpp"
#include "swiftprox/pair.hpp"
#include "swiftprox/point.hpp"
#include "swiftprox/pose.hpp"
#include "swiftprox/replay.hpp"
#include "swiftprox/scene.hpp"
#include "swiftprox/sets.hpp"
#include "swiftprox/shape.hpp"

#endif
