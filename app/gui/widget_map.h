// SPDX-License-Identifier: Apache-2.0
// Tells a test that works from outside, with the events of a real mouse, where things are on the screen:
// BEAM_STUDIO_MAP=FILE has the visible widgets written as JSON, over and over. It looks and never acts.
#pragma once

#include <QObject>
#include <QTimer>

#include <memory>

namespace beam {

class WidgetMap final : public QObject {
  Q_OBJECT

 public:
  explicit WidgetMap(const QString& file);

 private:
  void write();

  QString file_;
  QTimer timer_;
  int tick_ = 0;
};

// Writes where the environment asks for it, else does nothing.
std::unique_ptr<WidgetMap> widgetMapWanted();

}  // namespace beam
