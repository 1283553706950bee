"""4 again, on physics: modules that weigh, cables that stretch and have play."""
