// The files that assets.S embeds in the program.
#pragma once

#include <string_view>

namespace stiction::host::assets {

std::string_view frame_html();
std::string_view opening_html();
std::string_view closing_html();
std::string_view axes_html();
std::string_view axes_js();
std::string_view circle_html();
std::string_view experiment_html();
std::string_view identification_html();
std::string_view colours_css();
std::string_view report_css();
std::string_view scheme_js();
std::string_view page_js();
std::string_view models_js();
std::string_view figures_js();
std::string_view cursors_js();
std::string_view save_js();
std::string_view machine_js();
std::string_view circle_plots_js();
std::string_view circle_series_js();
std::string_view circle_tables_js();
std::string_view circle_js();
std::string_view charts_js();
std::string_view diagnosis_js();
std::string_view diagnosis_html();
std::string_view experiment_js();
std::string_view identification_js();
std::string_view step_cam_html();
std::string_view step_cam_js();
std::string_view fleet_html();
std::string_view fleet_js();
std::string_view plotly_js();
std::string_view plotly_license();

}  // namespace stiction::host::assets
