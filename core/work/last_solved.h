// SPDX-License-Identifier: Apache-2.0
// Which settings the frames of a project are taken from when it is drawn, written or scored: those in force
// where they are solved as far as it needs; else, all of them from one, the last ones that were.
#pragma once

#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/pipeline/project.h"

namespace beam {

struct WantedResults {
  std::string frames = "all";  // of selectSolvedFrames: any frame is enough for "all", of a list each
  bool between = false;        // frames between those of a scout count as solved
  bool materials = false, mesh = false;
  bool materials_if_any =
      false;            // enough without, but with them where some settings have them on the surface
  bool strict = false;  // nothing but the settings in force
};

struct LastSolved {
  Project project;                   // with the settings that the frames are taken from; never to be saved
  std::vector<std::string> changes;  // settingChanges from these to those in force; empty: they are the same

  // Where all were wanted: frames that it has no Gaussians of, though other settings or takes have.
  std::vector<FrameIndex> left_out = {};

  // Of those that are used: fitted and not refined, for the run was cut there.
  std::vector<FrameIndex> unfinished = {};

  // Where materials_if_any was asked for: without materials, though others of those that are used have some.
  std::vector<FrameIndex> bare = {};

  std::string leftOutText() const;     // a sentence of left_out, which has some
  std::string bareText() const;        // likewise
  std::string unfinishedText() const;  // likewise
  // Logs a warning that names what changed, where something did, and one of what is left out; once nothing
  // else is refused.
  void tell() const;
};

// Gives the project as it is where no settings in its history solved what is wanted, or it is looked at
// without its capture. Of frames in force without materials it takes those
// of other settings only on the same surface. Throws Error{Data} where `strict` alone refuses and where the
// settings in force solve some of the frames that are named and other ones all, Error{Usage} for frames that
// the capture does not have, Cancelled.
LastSolved lastSolved(const Project& project, const WantedResults& wanted, const Progress& progress);

}  // namespace beam
