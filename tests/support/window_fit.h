// SPDX-License-Identifier: Apache-2.0
// What of a window does not fit: widgets that lie over each other or outside, and words that are cut.
#pragma once

#include <QStringList>
#include <QWidget>

namespace beam::testing {

// Every fault in words, with its path. Excused by rule, never by name: what no layout of its parent manages
// lies over the others on purpose; what a scroll area scrolls may be larger than what is seen of it; words
// that end in an ellipsis and are whole in the tooltip.
QStringList faultsOfFit(QWidget& window);

}  // namespace beam::testing
