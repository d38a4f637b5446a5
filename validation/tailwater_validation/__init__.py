"""Scores Tailwater's runs against laboratory data. Needs numpy; pictures and particles need matplotlib and VTK."""
