"""Hachen, Shentu, Lilge and Burgner-Kahrs (2025): its experiments and claims, called paper B."""
