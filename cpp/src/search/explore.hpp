// SPDX-License-Identifier: BSD-3-Clause
// How the solutions of a goal are known, by the structure of the arm: finitely many branches, in
// closed form or as roots; a curve of them, of seven joints; what is left where some joints are
// held. Each function explores one such family in lanes, for a first answer or for all that are
// wanted. Y is the target as in reduction.hpp.
#pragma once

#include "search/first_answer.hpp"
#include "search/search_parts.hpp"

namespace iksel {

using FirstSearch = SearchParts<FirstAnswer>;
using AllSearch = SearchParts<Collector>;

/// Near, given seeds and all branches. `kind`: the proof that branches give.
template <typename Parts, typename Branches>
Explored explore_branches(const Parts& parts, Branches& branches, Proof kind, NearSeed& near,
                          GivenSeeds& given, const Pose& Y);

// On the self-motion of seven joints of which one can be swept.

/// By the sweep, and where that leaves a doubt by the ends of the self-motion's arcs.
Explored explore_curve(const FirstSearch& parts, const Pose& Y);
/// For one that is free in the goal's scene.
Explored explore_free_curve(const FirstSearch& parts, const Pose& Y);
/// For what the Collector wants, if that can be had there: the nearest, or a spread.
Explored explore_curve(const AllSearch& parts, const Pose& Y);
/// Of more than six joints of which none can be swept, for the nearest of the families of solutions
/// that have ends or that what was found belongs to: curves of seven joints, of more dimensions
/// else.
void explore_families(const AllSearch& parts, const Pose& Y);
/// By the ends of its arcs alone.
template <typename Parts>
Explored explore_ends(const Parts& parts);

/// Of longer chains, while all that is preferred stays where it is.
Explored explore_held(const AllSearch& parts);

/// For a full pose: the families that the arm has, and then the database. The proof that there are
/// no answers but those found.
Proof search_pose(const FirstSearch& parts, NearSeed& near, GivenSeeds& given, const Pose& Y);
Proof search_pose(const AllSearch& parts, NearSeed& near, GivenSeeds& given, const Pose& Y);

}  // namespace iksel
