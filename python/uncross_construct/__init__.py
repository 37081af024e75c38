"""Constructed inputs of operators (docs/port/packs.md), in Python's integers and fractions. `reference-data/construct` writes them."""
