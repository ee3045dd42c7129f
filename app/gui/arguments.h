// SPDX-License-Identifier: Apache-2.0
// What beam-studio is told on the command line.
#pragma once

#include <QCoreApplication>
#include <QString>

#include <optional>

#include "app/services.h"
#include "ui/main_window.h"
#include "ui/theme.h"

namespace beam {

struct StudioArguments {
  QString path;  // capture or project; empty: start page
  DeviceChoice device;
  StudioView view = StudioView::Splat;
  ChannelInfo channel = channelOf(kRelightChannel);
  QString camera, frame, environment, left, right, select, screenshot;
  double yaw_deg = 0;
  double photo = -1;  // opacity over the camera's render; < 0: as it comes
  bool sky = false, mesh = false, run = false, wait_run = false;
  QString until;
  RunScope scope = RunScope::Frame;
  int every = kScoutEvery;  // of a scout run
  QString in, out, curve;
  double play_s = 0;  // 0: not
  bool full_size = false;
  double frame_memory_mb = 0;  // 0: as the machine can spare
  Theme theme = Theme::Dark;
  int text_percent = 100;
  bool look_given = false;  // else as the person chose last
  double after_s = 0;       // the picture is taken that long after everything has settled
};

// Throws Error{Usage}. Answers --help and --version itself and ends the process.
StudioArguments parseArguments(QCoreApplication& application);

}  // namespace beam
