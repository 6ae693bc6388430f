"""The study's report: one HTML file that needs nothing else."""

from rovsim.reporting.html.page import Picture, ReportInputs, render, write

__all__ = ["Picture", "ReportInputs", "render", "write"]
