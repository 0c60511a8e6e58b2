// SPDX-License-Identifier: BSD-3-Clause
// An arm of spheres and its obstacles, as the kernel of collisions takes them (scene_kernel.hpp).
#pragma once

#include "base/motion_curve.hpp"
#include "simd/lane_types.hpp"

namespace iksel::lanes {

/// Bodies that move against each other, the base among them; chains have at most 64 joints that
/// move, mimic joints included, and side branches have others.
inline constexpr int kMaxBodies = 128;
/// A frame is its homogeneous matrix, column after column.
inline constexpr int kFrameRows = 4;
inline constexpr int kFrameNumbers = 16;

/// A body on its joint, whose axis is z: parent * (x, y, z, p) * motion.
struct SceneBody {
  double x[3], y[3], z[3], p[3];
  double multiplier, offset;  ///< motion = motion_of(body, q[variable]) [rad or m]
  int parent, variable;
  bool prismatic;
  const MotionCurve* curve;  ///< null: a straight line
};

struct SceneBall {
  double centre[3];  ///< in the body's frame [m]
  double radius;     ///< [m]
};

/// A node of a tree of balls. Its `count` balls stand in lanes: those of a leaf are a link's own,
/// of another node ball k is around all that is below node `first + k`.
struct SceneNode {
  alignas(64) double x[kWidth], y[kWidth], z[kWidth];  ///< centres in the body's frame [m]
  double radius[kWidth];                               ///< [m]
  int first, count;
  bool is_leaf;
};

/// Its balls are in the tree that hangs from node `root`.
struct SceneLink {
  int body, root;
  SceneBall around;  ///< around them all
};

/// Links beside each other that are on the same body.
struct SceneLinkRun {
  int body, first, count;
};

struct ScenePair {
  int a, b;  ///< links
};

/// Pairs of one link with others that stand beside each other: those of lane k, where bit k of the
/// mask is set, with link `first + k`.
struct ScenePairBlock {
  int one, first;  ///< `first` is a multiple of kWidth
  unsigned mask;
  int pair[kWidth];  ///< which pair it is
};

/// A box of which each point is the centre of a ball: boxes, and with edges of length 0 spheres and
/// capsules.
struct SceneBlock {
  double centre[3];
  double axis[3][3];  ///< its x, y and z axis in the base frame
  double half[3];     ///< half of each edge [m]
  double radius;      ///< with its margin [m]
  double around;      ///< radius of a ball around it all [m]
};

struct SceneCylinder {
  double centre[3];
  double axis[3];
  double radius, half;  ///< [m]
  double margin;        ///< [m]
};

/// All points x with normal . x <= offset.
struct ScenePlane {
  double normal[3];
  double offset;  ///< with its margin [m]
};

/// What refused the last configuration that was refused: those that are looked at one after the
/// other mostly fail by the same. Either a pair, or a link and one of the shapes of a kind.
struct SceneCulprit {
  enum class Kind { none, pair, block, cylinder, plane } kind = Kind::none;
  int index = 0;  ///< of the pair or the shape
  int link = 0;
  int leaf = 0;   ///< node whose balls were found to touch; of a pair of links the first's,
  int ball = 0;   ///< with the ball of it
  int other = 0;  ///< and the second's leaf
};

/// Room that find_clearance writes to.
struct SceneRoom {
  double* frame;    ///< of each body in the base frame, one after the other
  double* centre;   ///< of the balls around links: x of each, then y, z and the radius
  int link_stride;  ///< from x to y; kWidth more than there are links, at least
  int* near;        ///< pairs whose links are near each other
  SceneCulprit culprit;
};

/// find_clearance takes the joint values of one configuration, and returns its clearance:
/// distance^2 - radius^2 [m^2], the least of the balls that were found to touch, 1 if none does, or
/// 0 if the joint values are none. One that touches ends it.
struct SceneView {
  int bodies, links, link_runs, pairs, pair_blocks, blocks, cylinders, planes;
  double smaller;         ///< by so much is each ball than it says [m]
  int cleared;            ///< a body that touches no obstacle, as is known; 0 if none is
  const SceneBody* body;  ///< the first is the base, which has no joint
  const SceneLink* link;
  const SceneLinkRun* link_run;  ///< one after the other, of all links
  const double* around[4];       ///< the links' balls: x, y, z, radius; kWidth more than there are
  const SceneNode* node;
  const ScenePair* pair;
  const ScenePairBlock* pair_block;
  const SceneBlock* block;
  const SceneCylinder* cylinder;
  const ScenePlane* plane;
};

}  // namespace iksel::lanes
