"""What the papers say beside what is measured here."""
