// SPDX-License-Identifier: Apache-2.0
// A row of a form: how it marks a change, and what its tooltip tells of a value.
#include <gtest/gtest.h>

#include <QApplication>
#include <QLabel>
#include <QRegularExpression>

#include "core/stages/builtin_stages.h"
#include "ui/field_row.h"
#include "ui/theme.h"

namespace beam {
namespace {

TEST(FieldRows, WhatIsChangedStaysBoldUnderAnotherTheme) {
  auto& application = *static_cast<QApplication*>(QCoreApplication::instance());
  applyTheme(application, Theme::Dark);
  const Field field{{.name = "n", .label = "Iterations", .help = "How many."}, FieldValue(7)};
  FieldRow row(field);
  row.update(field, FieldValue(8), {});
  row.show();
  const auto* label = row.findChild<QLabel*>();
  EXPECT_TRUE(label->font().bold());
  for (const Theme theme : {Theme::Light, Theme::Dark}) {
    applyTheme(application, theme);
    QApplication::processEvents();
    EXPECT_TRUE(label->font().bold());
  }
  row.update(field, field.value, {});
  EXPECT_FALSE(label->font().bold());
  application.setStyleSheet({});
}

TEST(BuiltinStages, TellValuesAndRangesInFewDigitsAndWithoutCode) {
  StageRegistry registry;
  registerBuiltinStages(registry);
  const QRegularExpression ungrouped("(?<![\\d.,])\\d{4,}"),
      long_tail("[1-9]\\d*\\.\\d{6,}|\\.0*[1-9]\\d{6,}");
  for (const StageInfo& info : registry.infos()) {
    for (const Field& field : fieldsOf(*registry.make(info.id))) {
      FieldRow row(field);
      row.update(field, field.value, {});
      const QString facts = row.findChild<QLabel*>()->toolTip().section("<br>", 2, 2);
      EXPECT_TRUE(facts.startsWith("preset value ")) << facts.toStdString();
      for (const char* code : {"true", "false"}) EXPECT_FALSE(facts.contains(code)) << facts.toStdString();
      for (const QRegularExpression& wrong : {ungrouped, long_tail})
        EXPECT_FALSE(wrong.match(facts).hasMatch()) << info.id << ": " << facts.toStdString();
    }
  }
}

TEST(BuiltinStages, TellWhatBecomesOfResultsWhereATakeIsCutOtherwise) {
  StageRegistry registry;
  registerBuiltinStages(registry);
  int cuts = 0;
  for (const Field& field : fieldsOf(*registry.make("track"))) {
    if (field.info.name != "segment_frames" && field.info.name != "overlap") continue;
    ++cuts;
    FieldRow row(field);
    row.update(field, field.value, {});
    const QString tip = row.findChild<QLabel*>()->toolTip();
    EXPECT_TRUE(tip.contains("computed from now on")) << tip.toStdString();
    EXPECT_FALSE(tip.contains("never results")) << tip.toStdString();
  }
  EXPECT_EQ(cuts, 2);
}

}  // namespace
}  // namespace beam
