"""What the edges share: settings, loading, the pipeline, the study, tracking."""
