"""Pictures, films and reports, on any machine: no display, no graphics card, no OpenGL."""

from tempose.render.camera import Camera
from tempose.render.charts import line_chart
from tempose.render.colors import RAMPS, ramp_colors
from tempose.render.film import film, render, turntable
from tempose.render.follow import clip_cameras
from tempose.render.frame import render_frame
from tempose.render.report import html_report
from tempose.render.report_blocks import Cell, Chart, Figure, Numbers, Paragraph, Section, Table
from tempose.render.sheet import contact_sheet
from tempose.render.subject import ground_level
from tempose.render.themes import DARK, LIGHT, Theme
from tempose.render.video import save_mp4
from tempose.render.views import NAMED_VIEWS
from tempose.render.writers import save_gif, save_png

__all__ = [
    "DARK",
    "LIGHT",
    "NAMED_VIEWS",
    "RAMPS",
    "Camera",
    "Cell",
    "Chart",
    "Figure",
    "Numbers",
    "Paragraph",
    "Section",
    "Table",
    "Theme",
    "clip_cameras",
    "contact_sheet",
    "film",
    "ground_level",
    "html_report",
    "line_chart",
    "ramp_colors",
    "render",
    "render_frame",
    "save_gif",
    "save_mp4",
    "save_png",
    "turntable",
]
