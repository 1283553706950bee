"""Paper A: Qin, Huang, Chen, Song and Zhu (2020)."""
